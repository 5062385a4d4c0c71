#pragma once

#include "manoscope/core/arrays.hpp"
#include "manoscope/core/units.hpp"
#include "manoscope/flow/channel.hpp"
#include "manoscope/twin/uniform_curve.hpp"
#include "manoscope/wall/tapered_membrane.hpp"

namespace manoscope::twin {

/// Options of solve_coupled().
struct CoupledOptions {
  int steps = 2000;        ///< Runge-Kutta steps over the channel
  bool exact_duct = true;  ///< false: the paper's eq. (4)

  template <class Visitor>
  void describe(Visitor&& visit) {
    visit("steps", steps, "Runge-Kutta steps over the channel length, at least 10");
    visit("exact_duct", exact_duct,
          "side walls by the exact series of a rectangular duct, not by 1 - 0.63 h/w");
  }
  /// @throws InputError naming the option out of range.
  void validate() const;
};

/// Flow through a channel whose wall gives way to it.
struct CoupledFlow {
  UniformCurve pressure;    ///< gauge pressure p(x), Pa, at steps + 1 nodes
  UniformCurve deflection;  ///< width-averaged zeta(x), m, at the same nodes

  Pressure inlet() const { return Pressure::from_si(pressure.values()(0)); }
  Pressure outlet() const {
    return Pressure::from_si(pressure.values()(pressure.values().size() - 1));
  }
};

/// Steady creeping flow coupled to a wall that answers to the pressure at x alone.
///
///   dp/dx = -Q r(2 h0 + zeta(x; p)),  p(l) = p_out
///
/// Source: Ozsun, Yakhot & Ekinci (2013), eqs. (2) and (4), closed by the wall law instead of a
/// calibration. Marched from the outlet by the classical fourth-order Runge-Kutta method; with the
/// default 2000 steps the numerical error of p(x) is below 1e-6 of the drop for the scenarios that
/// ship. Validity: that of flow::one_dimensional_pressure() and wall::TaperedMembrane; the section
/// is taken as a rectangle of the mean gap. Inertia is left out, so p falls monotonically.
///
/// @throws InputError if the wall touches the floor (2 h0 + zeta <= 0), naming where, if half the
///         steps give a drop that differs by more than 0.1 %, if wall and channel differ in length,
///         or if an input is out of range.
CoupledFlow solve_coupled(const flow::Channel& channel, const flow::Fluid& fluid,
                          const wall::TaperedMembrane& wall, FlowRate flow_rate,
                          Pressure outlet_pressure, const CoupledOptions& options = {});

}  // namespace manoscope::twin
