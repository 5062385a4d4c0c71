#pragma once

#include <vector>

#include "manoscope/calibration/constitutive_curves.hpp"
#include "manoscope/core/uncertainty.hpp"
#include "manoscope/inversion/read_pressure.hpp"
#include "manoscope/validation/flow_setup.hpp"

namespace manoscope::validation {

/// The wall as its constitutive curves have it, with the clamped ends: zeta of a pressure.
///
/// Beyond its calibrated range a curve goes on straight for a share of that range, then stays.
class CurvedWall {
 public:
  /// @throws InputError if no station inside the channel has a curve.
  CurvedWall(const calibration::ConstitutiveCurves& curves, Length length,
             double largest_extrapolation);

  const Array1& x() const { return x_; }                          ///< (n) m
  const std::vector<Index>& station() const { return station_; }  ///< as in WallLine
  Index size() const { return x_.size(); }

  double zeta(Index i, double pressure) const;   ///< m
  double slope(Index i, double pressure) const;  ///< m/Pa
  bool is_outside(Index i, double pressure) const;
  /// Pa beyond what the straight continuation serves; 0 inside.
  double beyond(Index i, double pressure) const;
  double highest(Index i) const;  ///< Pa, of the curve; infinite at an end

  /// Range of zeta that the wall can take, m.
  double least() const { return least_; }
  double greatest() const { return greatest_; }

  WallLine line(const Array1& pressure) const;
  /// Errors of zeta at these pressures, m, held fixed: those of the curves.
  Uncertainty errors(const Array1& pressure, const inversion::GaugeErrors& gauge) const;

 private:
  const calibration::ConstitutiveCurve* curve(Index i) const;
  double room(const calibration::ConstitutiveCurve& curve) const;

  calibration::ConstitutiveCurves curves_;
  double extrapolation_;
  Array1 x_;
  std::vector<Index> station_;
  double least_ = 0.0, greatest_ = 0.0;
};

}  // namespace manoscope::validation
