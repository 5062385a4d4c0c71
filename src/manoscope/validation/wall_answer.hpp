#pragma once

#include <vector>

#include "manoscope/calibration/constitutive_curves.hpp"
#include "manoscope/core/uncertainty.hpp"
#include "manoscope/inversion/read_pressure.hpp"
#include "manoscope/validation/flow_setup.hpp"

namespace manoscope::validation {

/// The wall as its constitutive curves have it, with the clamped ends: zeta of a pressure.
///
/// Beyond its calibrated range a curve goes on straight for a share of that range, or until zeta
/// has gone on by the same share of the largest range of zeta, whichever is less; then it stays. A
/// stiffening wall is so soft at 0 Pa that a share of p alone would close the channel.
///
/// A station whose curve ends far from where most do, since levels are missing there or cannot be
/// told apart, has no say: zeta is straight between its neighbours.
class CurvedWall {
 public:
  /// @param largest_extrapolation  that share; also how far the ends of a curve may lie inside
  /// those
  ///                               of the median curve.
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
  double lowest(Index i) const;   ///< Pa, of the curve; -infinite at an end
  double highest(Index i) const;  ///< Pa, of the curve; infinite at an end

  /// Range of zeta that the wall can take, m.
  double least() const { return least_; }
  double greatest() const { return greatest_; }

  WallLine line(const Array1& pressure) const;
  /// Errors of zeta at these pressures, m, held fixed: those of the curves.
  Uncertainty errors(const Array1& pressure, const inversion::GaugeErrors& gauge) const;

 private:
  const calibration::ConstitutiveCurve* curve(Index i) const;
  /// How far a curve goes on beyond the end at this pressure, Pa.
  double room(const calibration::ConstitutiveCurve& curve, double end) const;

  calibration::ConstitutiveCurves curves_;
  double extrapolation_;
  double largest_span_ = 0.0;  ///< m, of zeta over the range of a curve
  Array1 x_;
  std::vector<Index> station_;
  double least_ = 0.0, greatest_ = 0.0;
};

}  // namespace manoscope::validation
