#pragma once

#include "manoscope/core/profile.hpp"
#include "manoscope/inversion/read_pressure.hpp"
#include "manoscope/inversion/test_section.hpp"
#include "manoscope/validation/flow_setup.hpp"

namespace manoscope::validation {

/// p(x) that satisfies the flow model as well as the wall. Offered, never the reading itself: it is
/// no longer independent of the flow, so that it must not be compared with a flow model.
///
///   d = W (p_read - p_model), W: mean pressures of pieces less the last;  E d = 0
///   p = p_read - C_pd C_dd^-1 d,   cov p = C_pp - C_pd C_dd^-1 C_dp
///
/// The best linear estimate given both, with the covariances of all error variables: zeta in both,
/// labels and gauge in p_read, gap, viscosity, flow rate, model and inlet profile in p_model.
///
/// Source: conditioning of a normal vector on linear constraints (GUM supplement JCGM 102:2011 for
/// the covariances). Validity: where compare_models() finds agreement; a wrong model pulls p(x)
/// towards itself by more than the bars then say.
///
/// @return the reading with pressure, uncertainty and a 95 % interval anew; flags and slope as they
///         were.
/// @throws InputError as flow::pressure_along() and piece_weights().
inversion::PressureReading joint_pressure(const FlowSetup& setup, flow::FlowModel model,
                                          FlowRate flow_rate, const Profile& state,
                                          const inversion::PressureReading& reading,
                                          const inversion::TestSection& section,
                                          Index n_pieces = 12);

}  // namespace manoscope::validation
