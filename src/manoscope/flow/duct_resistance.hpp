#pragma once

#include "manoscope/core/arrays.hpp"
#include "manoscope/core/units.hpp"

namespace manoscope::flow {

/// How the side walls of a rectangular duct enter its resistance.
enum class DuctFormula {
  wide_duct,  ///< 1 - 0.63 h/w, the paper's eq. (4)
  series,     ///< the exact Fourier series
};

/// Side-wall factor F of a rectangular duct: Q = w h^3 F / (12 eta) (-dp/dx), 0 < F < 1.
///
///   wide_duct:  F = 1 - 0.63 h/w
///   series:    F = 1 - (192/pi^5) (h/w) sum_{n = 1, 3, 5, ...} tanh(n pi w / (2 h)) / n^5
///
/// Source: the series of fully developed laminar flow between four plane walls as in H. Bruus,
/// Theoretical Microfluidics (2008), ch. 3; wide_duct takes every tanh as 1, for which the sum is
/// 31 zeta(5)/32 and the factor 0.6302, and is used in eq. (4) of Ozsun, Yakhot & Ekinci (2013).
///
/// Accuracy. The series is summed to round-off (1e-14 relative): tanh is split into 1 and an
/// exponentially small rest. The resistance by wide_duct is within 8e-5 (relative) for
/// h/w <= 0.35 (low by 2.7e-5 at 0.1), high by 0.15 % at 0.5 and by 14 % at 1.
///
/// @param h_over_w  gap over width; in (0, 1] for wide_duct, any positive number for the series
///                  (a duct higher than wide is the same duct turned over).
/// @throws InputError if out of range.
double duct_flow_factor(double h_over_w, DuctFormula formula);

/// Hydraulic resistance per unit length r = (-dp/dx) / Q of a rectangular duct.
///
///   r = 12 eta / (w h^3 F)
///
/// Source: with wide_duct, Ozsun, Yakhot & Ekinci (2013), eq. (4), where 2h(x) = 2 h0 + zeta(x) is
/// our gap h. Accuracy: see duct_flow_factor(). Validity: fully developed creeping or
/// unidirectional laminar flow; a bulged section is not a rectangle of its mean height and resists
/// less.
///
/// @param eta  dynamic viscosity, > 0.
/// @param w    duct width, > 0.
/// @param h    gap, > 0, and <= w for wide_duct.
/// @return Pa s / m^4.
/// @throws InputError if a size is out of range.
double duct_resistance(Viscosity eta, Length w, Length h,
                       DuctFormula formula = DuctFormula::wide_duct);

/// The same for many gaps.
/// @param gap  (n), m.
/// @return (n), Pa s / m^4.
/// @throws InputError naming the first gap that is out of range.
Array1 duct_resistance(Viscosity eta, Length w, const Array1& gap,
                       DuctFormula formula = DuctFormula::wide_duct);

/// Derivative dr/dh of duct_resistance() with respect to the gap, about -3 r/h.
/// @return Pa s / m^5.
/// @throws InputError if a size is out of range.
double duct_resistance_slope(Viscosity eta, Length w, Length h,
                             DuctFormula formula = DuctFormula::wide_duct);

/// The same for many gaps: (n), m in; (n), Pa s / m^5 out.
Array1 duct_resistance_slope(Viscosity eta, Length w, const Array1& gap,
                             DuctFormula formula = DuctFormula::wide_duct);

}  // namespace manoscope::flow
