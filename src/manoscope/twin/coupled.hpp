#pragma once

#include "manoscope/core/arrays.hpp"
#include "manoscope/core/monitor.hpp"
#include "manoscope/core/units.hpp"
#include "manoscope/flow/channel.hpp"
#include "manoscope/flow/roof.hpp"
#include "manoscope/twin/channel_curve.hpp"
#include "manoscope/twin/coupled_options.hpp"
#include "manoscope/twin/wall_model.hpp"

namespace manoscope::twin {

/// Flow through a channel whose wall gives way to it.
struct CoupledFlow {
  FlowRate flow_rate{};
  ChannelCurve pressure;    ///< gauge pressure p(x), Pa, at steps + 1 nodes
  ChannelCurve deflection;  ///< width-averaged zeta(x), m, at the same nodes
  WallAtRest wall;
  double speed_index = 0.0;  ///< largest S along the channel; 1 = choked
  /// Of its sections, as CoupledOptions::flow_model took it; the rectangle has no use for it.
  flow::WallShape section = flow::WallShape::parabola();

  Pressure inlet() const { return Pressure::from_si(pressure.values()(0)); }
  Pressure outlet() const {
    return Pressure::from_si(pressure.values()(pressure.values().size() - 1));
  }
};

/// The channel under one pressure everywhere and without flow: wall at `from`, slowly loaded.
///
/// @throws InputError if the wall touches the floor or would rise beyond its theory
///         (WallModel::largest_pressure), or an input is out of range.
CoupledFlow fill_channel(const flow::Channel& channel, const WallModel& wall,
                         const WallAtRest& from, Pressure pressure,
                         const CoupledOptions& options = {});

/// Steady flow coupled to a wall: p(x) = what the flow has under zeta(x), zeta = the wall's answer
/// to p(x), p(l) = p_out.
///
/// flow_model = "rectangle" is the momentum balance of a rectangle of the mean gap,
///
///   A dp/dx = -A r Q - d/dx (beta rho Q^2/A),  A = w (2 h0 + zeta(x)),
///
/// integrated over x (MomentumEquation).
///
/// Source: Ozsun, Yakhot & Ekinci (2013), eqs. (2) and (4), closed by a wall law instead of a
/// calibration, with the momentum integral of unidirectional profiles (beta = 6/5 for a parabola).
/// Validity: fully developed flow, a section taken as a rectangle of the mean gap; momentum
/// closure at large reduced Reynolds numbers is good to 5-10 % of p (marching models do better).
///
/// Newton's method on p at the nodes with the wall's own influence operator, integrals of fourth
/// order; from the start, flow rate and outlet pressure change in proportion, by steps that are
/// halved until each converges, so that a wall with several states stays on its branch. p meets
/// the equation to 1e-9 of the drop.
///
/// Any other flow_model is flow::pressure_along() at the nodes, with one shape of the section for
/// the whole channel: section_shape() of the wall under the flow of the rectangle at this flow
/// rate. From that flow on the same method goes to the model's, its tangent still that of the
/// rectangle, which leaves a tenth of the residual at each step or less. p meets the model to
/// 1e-5 of the drop: a tenth of what the best of them is off. Second order in the nodes; validity
/// is that of the model.
///
/// Waves travel against the flow as long as S^2 = beta rho Q^2 (dA/dp)/A^3 < 1, dA/dp under
/// uniform pressure. At S = 1 the channel chokes and no steady flow of this Q exists. Beside a flow
/// model S is that of the rectangle, beta = 6/5 (creeping ones: 0).
///
/// @param start  the channel before, e.g. of fill_channel() or a lower flow rate.
/// @throws InputError if the wall touches the floor, naming where; if it would rise beyond its
///         theory; if the channel chokes; if the flow of a model separates or has no answer; if
///         half the steps give a drop that differs by more than 0.1 %; if wall and channel differ
///         in length, or an input is out of range.
/// @throws Interrupted if the monitor says so.
CoupledFlow solve_coupled(const flow::Channel& channel, const flow::Fluid& fluid,
                          const WallModel& wall, const CoupledFlow& start, FlowRate flow_rate,
                          Pressure outlet_pressure, const CoupledOptions& options = {},
                          const Monitor& monitor = {});

}  // namespace manoscope::twin
