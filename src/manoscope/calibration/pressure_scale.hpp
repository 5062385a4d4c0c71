#pragma once

#include <vector>

#include "manoscope/calibration/levels.hpp"

namespace manoscope::calibration {

/// The coordinate in which curves are interpolated: the u for which
///
///   p = p_s (u + u^3),
///
/// linear below p_s and p^(1/3) above. A long clamped membrane, p = a zeta + b zeta^3, has a zeta
/// that is exactly proportional to u if p_s = a^(3/2) / b^(1/2); a plate has p_s -> infinity, u ~
/// p. Only the interpolation between levels uses it: no wall law is imposed on the curves.
class PressureScale {
 public:
  /// @param unit  p_s, Pa, above 0.
  /// @throws InternalError if it is not.
  explicit PressureScale(double unit);

  double coordinate(double pressure) const;
  double pressure(double coordinate) const;
  /// d u / d p, 1/Pa.
  double derivative(double pressure) const;
  double unit() const { return unit_; }  ///< p_s, Pa

 private:
  double unit_;
};

/// The scale in which the curves of all stations together come nearest to straight lines: least sum
/// of squared distances from them, among p_s in ratio steps of 1.2 from a tenth of the smallest
/// step between levels to a hundred times the largest pressure.
///
/// @param levels  at two pressures or more. Stations with fewer than 3 levels do not
/// count.
PressureScale fit_pressure_scale(const std::vector<Level>& levels);

}  // namespace manoscope::calibration
