#pragma once

#include "manoscope/wall/fit_law.hpp"

namespace manoscope::wall {

/// Log-log slope of deflection against pressure over a range of pressures.
struct CrestPower {
  double exponent = 0.0;  ///< d ln zeta / d ln p
  double sigma = 0.0;     ///< standard uncertainty, k = 1
  double scale = 0.0;     ///< zeta at 1 Pa of the fitted power law, m
  double chi2 = 0.0;      ///< of the straight line in ln p, ln zeta
  Index n_points = 0;
  double probability = 0.0;  ///< of a larger chi2; small where the slope is not constant
  PressureRange range{};     ///< the pressures used, lowest and highest
};

/// Power law of the wall: 1 for bending and for prestress, 1/3 for a stretched membrane (fig. 1(f)
/// of Ozsun, Yakhot & Ekinci 2013), in between where they meet.
///
/// Weighted straight line through (ln p, ln zeta), errors in both by the effective variance
/// (sigma_zeta/zeta)^2 + exponent^2 (sigma_p/p)^2, repeated until the exponent stands. Crest and
/// width-averaged deflection give the same exponent where the shape is constant. Deflections must
/// count from the plane of the flat wall: an offset bends the line.
///
/// Validity: relative errors below about 10 % (the logarithm of a noisy value is biased by -1/2
/// its square).
/// @param range  Points with low <= p <= high are used; p > 0 and deflection > 0 there.
/// @throws InputError if fewer than 3 points lie in the range, or one of them is not positive.
CrestPower crest_power(const HydrostaticData& data, const PressureRange& range);

}  // namespace manoscope::wall
