#pragma once

#include <vector>

#include "manoscope/core/units.hpp"
#include "manoscope/flow/pressure_term.hpp"

namespace manoscope::flow {

/// Drop of the passages from a simulation, at one flow rate.
struct SimulatedDrop {
  FlowRate flow_rate{};
  Pressure drop{};
  Pressure uncertainty{};  ///< standard; of the mesh, the sizes and what was left out
};

/// Parasitic drop at a flow rate between or near simulated ones: dp = a Q + b Q^2 by least squares.
///
/// Source: friction linear, inertia quadratic in Q, as the paper's appendix A has it from its
/// simulations. Weights are the uncertainties where all are positive, else equal.
/// Errors of flow rate and viscosity: a Q moves with both, b Q^2 with the flow rate twice. A single
/// simulation does not tell these parts: it counts as inertial under the flow rate and as viscous
/// under the viscosity, the most that either can do.
/// Validity: from 0 to the largest simulated flow rate; one simulation serves its own flow rate
/// alone (to 1 %).
/// @throws InputError outside that, without simulations, or for a flow rate that is not positive.
PressureTerm simulated_drop(const std::vector<SimulatedDrop>& simulations, FlowRate flow_rate);

}  // namespace manoscope::flow
