#pragma once

#include "manoscope/core/arrays.hpp"
#include "manoscope/core/monitor.hpp"
#include "manoscope/core/units.hpp"
#include "manoscope/flow/channel.hpp"
#include "manoscope/twin/channel_curve.hpp"
#include "manoscope/twin/wall_model.hpp"

namespace manoscope::twin {

/// Options of solve_coupled().
struct CoupledOptions {
  int steps = 240;               ///< over the channel
  bool exact_duct = true;        ///< false: the paper's eq. (4)
  double momentum_factor = 1.2;  ///< beta; 0 = creeping flow

  template <class Visitor>
  void describe(Visitor&& visit) {
    visit("steps", steps, "steps over the channel length, even, at least 10");
    visit("exact_duct", exact_duct,
          "side walls by the exact series of a rectangular duct, not by 1 - 0.63 h/w");
    visit("momentum_factor", momentum_factor,
          "beta of the momentum flux: 1.2 = parabolic profile, 0 = creeping flow");
  }
  /// @throws InputError naming the option out of range.
  void validate() const;
};

/// Flow through a channel whose wall gives way to it.
struct CoupledFlow {
  FlowRate flow_rate{};
  ChannelCurve pressure;    ///< gauge pressure p(x), Pa, at steps + 1 nodes
  ChannelCurve deflection;  ///< width-averaged zeta(x), m, at the same nodes
  WallAtRest wall;
  double speed_index = 0.0;  ///< largest S along the channel; 1 = choked

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

/// Steady flow coupled to a wall.
///
///   A dp/dx = -A r Q - d/dx (beta rho Q^2/A),  A = w (2 h0 + zeta(x)),  p(l) = p_out,
///   zeta = the wall's answer to p(x)
///
/// integrated over x:
///
///   p(x) = p_out + int_x^l r Q dx' + (beta rho Q^2/2) (1/A(l)^2 - 1/A(x)^2).
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
/// Waves travel against the flow as long as S^2 = beta rho Q^2 (dA/dp)/A^3 < 1, dA/dp under
/// uniform pressure. At S = 1 the channel chokes and no steady flow of this Q exists.
///
/// @param start  the channel before, e.g. of fill_channel() or a lower flow rate.
/// @throws InputError if the wall touches the floor, naming where; if it would rise beyond its
///         theory; if the channel chokes; if half
///         the steps give a drop that differs by more than 0.1 %; if wall and channel differ in
///         length, or an input is out of range.
/// @throws Interrupted if the monitor says so.
CoupledFlow solve_coupled(const flow::Channel& channel, const flow::Fluid& fluid,
                          const WallModel& wall, const CoupledFlow& start, FlowRate flow_rate,
                          Pressure outlet_pressure, const CoupledOptions& options = {},
                          const Monitor& monitor = {});

}  // namespace manoscope::twin
