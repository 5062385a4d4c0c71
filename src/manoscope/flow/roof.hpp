#pragma once

#include <functional>
#include <vector>

#include "manoscope/core/arrays.hpp"
#include "manoscope/core/units.hpp"

namespace manoscope::flow {

/// The section of a channel: flat floor y = 0, vertical sides z = -w/2 and w/2, roof y = h(z).
///
/// Positions across are s = 2 z / w in [-1, 1].
struct Roof {
  Length width{};
  std::function<double(double s)> gap;    ///< h, m, > 0 inside
  std::function<double(double s)> slope;  ///< dh/ds, m
};

/// Shape of a deflected wall across the channel: zeta(z) = mean deflection * g(s), g even, mean 1.
///
///   g(s) = sum over k of c_k s^(2k) / sum over k of c_k / (2k + 1)
///
/// parabola (membrane) 1.5 (1 - s^2), clamped plate strip 1.875 (1 - s^2)^2.
class WallShape {
 public:
  /// @param even_powers  c_0, c_1, ..: coefficients of 1, s^2, s^4, ..; any scale.
  /// @throws InputError if there are none, one is not finite, or their mean over the width is 0.
  explicit WallShape(std::vector<double> even_powers);

  static WallShape rigid() { return WallShape({1.0}); }  ///< a flat wall that moves as a whole
  static WallShape parabola() { return WallShape({1.0, -1.0}); }
  static WallShape clamped_strip() { return WallShape({1.0, -2.0, 1.0}); }

  /// Least squares through a measured section, of zeros at the sides: g ~ (1 - s^2)(a_0 + a_1 s^2
  /// ..).
  ///
  /// The odd part of the section is left out: it moves the resistance in second order only.
  /// @param s      (n) positions 2 z / w in [-1, 1].
  /// @param zeta   (n) deflection there, any unit.
  /// @param terms  number of coefficients a_k, >= 1; fewer than n.
  /// @throws InputError if the sizes differ, a position is outside, the stations are too few, or
  ///         the mean of the fit is 0.
  static WallShape fit(const Array1& s, const Array1& zeta, int terms = 2);

  double value(double s) const;
  double slope(double s) const;  ///< dg/ds
  double crest() const { return value(0.0); }
  const std::vector<double>& coefficients() const { return coefficients_; }

 private:
  std::vector<double> coefficients_;  ///< of s^(2k); the mean is 1
};

/// Roof h(s) = height + mean deflection * g(s).
/// @throws InputError if the width is not positive or the gap is not positive at s = 0 or +-1.
Roof bulged_roof(Length width, Length height, Length mean_deflection, const WallShape& shape);

/// Flat roof: a rectangular duct.
Roof flat_roof(Length width, Length height);

}  // namespace manoscope::flow
