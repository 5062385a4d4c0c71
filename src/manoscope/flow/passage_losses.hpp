#pragma once

#include <optional>
#include <string>
#include <vector>

#include "manoscope/core/uncertainty.hpp"
#include "manoscope/core/units.hpp"
#include "manoscope/flow/channel.hpp"
#include "manoscope/flow/parasitic.hpp"

namespace manoscope::flow {

using Area = Quantity<0, 2, 0>;

/// What stands at the ends of a rigid passage and in it.
struct PassageFittings {
  /// Section that the flow comes from, through a sudden contraction; unset: no step, developed
  /// flow.
  std::optional<Area> from;
  bool from_reservoir = false;  ///< from a section without bound, instead of `from`
  std::optional<Area> into;     ///< section that it goes to, through a sudden expansion
  bool into_reservoir = false;
  int round_bends = 0;  ///< 90 degrees, centre radius about one hydraulic diameter
  int mitre_bends = 0;  ///< 90 degrees, sharp corner
};

/// One part of a pressure drop, static pressure before less static pressure behind.
struct PressureTerm {
  std::string name;
  std::string source;
  Pressure drop{};
  Pressure uncertainty{};  ///< standard, of the formula alone: sizes and viscosity are not in it
};

/// Pressure drop of a rigid passage, part by part. U = Q/A, Re = U Dh/nu, sigma = small/large area.
///
///   duct         passage_drop(): exact
///   contraction  rho U^2/2 (1 - sigma^2): gain of kinetic energy without loss, to a flat profile
///   development  rho U^2/2 K(x+): entry_excess(), after a contraction or reservoir
///   expansion    -rho U^2 sigma (beta_1 - beta_2 sigma): the pressure that a sudden widening gives
///                back, beta of developed flow
///   steps        3/2 eta Q/R^3 for each, R = Dh/2: the creeping flow towards and from an end
///   bends        rho U^2/2 (K_1/Re + K_inf): 800, 0.25 (round); 1000, 1.15 (mitre)
///
/// Sources: development R. K. Shah, J. Fluids Eng. 100 (1978) 177. Contraction and expansion by the
/// balances of energy and momentum that W. M. Kays, Trans. ASME 72 (1950) 1067, tabulates; he adds
/// the loss behind the edge, up to 0.1 rho U^2/2 in laminar flow. Steps: half of Sampson's exact
/// 3 eta Q/R^3 of a hole in a thin plate (1891), which H. L. Weissberg, Phys. Fluids 5 (1962) 1033,
/// adds to the friction of a short tube for its two ends. Bends: W. B. Hooper, Chem. Eng. 88 (1981)
/// 96, elbows flanged with R/D = 1 and mitred with one weld, without his term in the pipe's
/// diameter in inches, which is not meant for these sizes.
///
/// Standard uncertainties (rectangular, half width / sqrt 3):
///   development 10 % of it; contraction 0.1 rho U^2/2; expansion 30 % of it, for at low Re less is
///   given back; steps half, for the section is not round and a step to a finite section takes
///   less; bends all of it (from nothing to twice): measured on pipes above Re = 10, while a bend
///   in creeping flow costs less than its own length.
/// Validity: laminar, one step or bend not felt by the next. A three-dimensional simulation is
/// better where one is there (simulated_drop()).
///
/// @throws InputError if a size, the fluid or the flow rate is not positive, an area is smaller
///         than the passage's or a number of bends is negative.
std::vector<PressureTerm> passage_terms(const Fluid& fluid, FlowRate flow_rate,
                                        const RigidPassage& passage,
                                        const PassageFittings& fittings);

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
/// Validity: from 0 to the largest simulated flow rate; one simulation serves its own flow rate
/// alone (to 1 %).
/// @throws InputError outside that, without simulations, or for a flow rate that is not positive.
PressureTerm simulated_drop(const std::vector<SimulatedDrop>& simulations, FlowRate flow_rate);

/// Sum of the terms, each an error variable of its own, and the viscosity as one for all.
///
/// @param viscosity_uncertainty  relative; reaches the share of the drop that goes with viscosity,
///                               taken as all of it.
Estimate parasitic_estimate(const std::vector<PressureTerm>& terms, double viscosity_uncertainty);

/// Drop of the compliant channel as the transducer has it: reading less parasitic drop.
///
/// Source: Ozsun, Yakhot & Ekinci (2013), fig. 2(a).
/// @param uncertainty  standard, of the transducer's reading.
Estimate compliant_drop(Pressure transducer, Pressure uncertainty, const Estimate& parasitic);

}  // namespace manoscope::flow
