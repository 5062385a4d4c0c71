#pragma once

#include "manoscope/core/arrays.hpp"
#include "manoscope/core/units.hpp"
#include "manoscope/flow/channel.hpp"
#include "manoscope/flow/duct_resistance.hpp"

namespace manoscope::flow {

/// Options of one_dimensional_pressure().
struct OneDimensionalOptions {
  /// True: exact side walls; false: the paper's eq. (4), 1 - 0.63 h/w.
  bool exact_duct = true;

  DuctFormula formula() const { return exact_duct ? DuctFormula::series : DuctFormula::wide_duct; }

  template <class Visitor>
  void describe(Visitor&& visit) {
    visit("exact_duct", exact_duct,
          "side walls by the exact series of a rectangular duct, not by 1 - 0.63 h/w");
  }
};

/// Pressure p(x) of creeping flow through a channel whose wall stands still in the shape zeta(x).
///
///   dp/dx = -Q r(2 h0 + zeta(x)),  p(l) = p_out
///
/// Source: Ozsun, Yakhot & Ekinci (2013), eqs. (2) and (4); lubrication with side walls. Trapezoid
/// rule on the given stations, second order. Validity: slender (gap much less than length) and
/// reduced Reynolds number Re h/l << 1: inertia and the development of the flow are left out, which
/// at 70 mL/min in the paper's channels moves p(x) by about 10 % of the inlet pressure.
///
/// @param x     (n) stations, m, strictly ascending; the last at most one spacing from the outlet.
/// @param zeta  (n) width-averaged deflection, m.
/// @param outlet_pressure  gauge pressure at x = l.
/// @return (n) gauge pressure, Pa.
/// @throws InputError as resistance_drop().
Array1 one_dimensional_pressure(const Channel& channel, const Fluid& fluid, FlowRate flow_rate,
                                const Array1& x, const Array1& zeta, Pressure outlet_pressure,
                                const OneDimensionalOptions& options = {});

/// Pressure that the fluid's gain of speed takes between two sections, in addition to friction:
///
///   p_start - p_end = (beta rho Q^2/2) (1/A_end^2 - 1/A_start^2),  A = w (2 h0 + zeta)
///
/// Source: the momentum integral A dp = -d(beta rho Q^2/A) of unidirectional profiles, beta = 6/5
/// of a parabola (1 of a flat profile). Negative where the flow widens. Not in Ozsun, Yakhot &
/// Ekinci (2013), eq. (4), which is friction alone.
///
/// @throws InputError if a gap is not positive.
Pressure acceleration_drop(const Channel& channel, const Fluid& fluid, FlowRate flow_rate,
                           Length zeta_start, Length zeta_end, double momentum_factor = 1.2);

}  // namespace manoscope::flow
