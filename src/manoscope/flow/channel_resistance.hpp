#pragma once

#include "manoscope/core/arrays.hpp"
#include "manoscope/core/units.hpp"
#include "manoscope/flow/channel.hpp"
#include "manoscope/flow/duct_resistance.hpp"

namespace manoscope::flow {

/// Weights of the trapezoid rule on [x1, x2]: integral of f = sum_i weight_i f(x_i).
///
/// Exact for the piecewise linear interpolant of f; x1 and x2 may lie between stations. Before the
/// first and after the last station f is held constant, for at most one spacing of the neighbouring
/// stations (pixel centres stand half a pixel inside the channel's edges). Second order in the
/// spacing for smooth f.
///
/// @param x  (n) stations, m, strictly ascending, n >= 2, spacing free.
/// @return (n), m.
/// @throws InputError if the stations are not ascending, x1 >= x2, or [x1, x2] reaches farther than
///         one spacing beyond them.
Array1 interval_weights(const Array1& x, Length x1, Length x2);

/// A pressure drop and what moves it.
struct ResistanceDrop {
  Pressure drop{};               ///< Q R
  Array1 zeta_gradient;          ///< (n) d(drop)/d zeta(x_i), Pa/m
  double height_gradient = 0.0;  ///< d(drop)/d(2 h0), Pa/m; the sum of zeta_gradient
};

/// Pressure drop Q R of a channel between x1 and x2, R = integral of r(x) dx over [x1, x2].
///
///   r(x) from duct_resistance() at the gap h(x) = 2 h0 + zeta(x)
///
/// Source: Ozsun, Yakhot & Ekinci (2013), eq. (4) and the definition of R that follows fig. 3.
/// Quadrature: interval_weights(). Validity: that of duct_resistance(), so no inertia and no
/// developing flow; p falls along +x for Q > 0.
///
/// @param x     (n) stations, m, strictly ascending.
/// @param zeta  (n) width-averaged deflection, m.
/// @throws InputError as interval_weights() and duct_resistance(), or if the shapes differ.
ResistanceDrop resistance_drop(const Channel& channel, Viscosity eta, FlowRate flow_rate,
                               const Array1& x, const Array1& zeta, Length x1, Length x2,
                               DuctFormula formula = DuctFormula::wide_duct);

/// Running drop Q integral r dx from the first station to each, by the trapezoid rule.
/// @return (n), Pa; 0 at the first station.
/// @throws InputError as resistance_drop().
Array1 running_resistance_drop(const Channel& channel, Viscosity eta, FlowRate flow_rate,
                               const Array1& x, const Array1& zeta,
                               DuctFormula formula = DuctFormula::wide_duct);

/// Local Reynolds number Re_x = 2 Q / (nu (w + h)) on the hydraulic diameter 2 w h/(w + h).
///
/// Source: Ozsun, Yakhot & Ekinci (2013), caption of table I, where 2h(x) is our gap h.
/// @return (n), dimensionless, never negative: the magnitude of Q counts.
Array1 local_reynolds(const Channel& channel, const Fluid& fluid, FlowRate flow_rate,
                      const Array1& zeta);

/// Mean of Re_x over the whole channel, x in [0, length] (table I).
/// @throws InputError as interval_weights(), so if the stations do not cover the channel.
double channel_reynolds(const Channel& channel, const Fluid& fluid, FlowRate flow_rate,
                        const Array1& x, const Array1& zeta);

}  // namespace manoscope::flow
