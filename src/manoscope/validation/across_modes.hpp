#pragma once

#include "manoscope/core/arrays.hpp"
#include "manoscope/flow/roof.hpp"

namespace manoscope::validation {

/// One shape of a wall across the channel, and the departures from it.
///
/// Column 0 is the shape g(s) of mean 1, s = 2 z/w; the others, psi_k(s), are polynomials that are
/// 0 at both sides, where the wall is clamped, have mean 0 and mean square 1 over the width and are
/// orthogonal to each other: even ones first, then odd ones. So that
///
///   zeta(s) = mean deflection * g(s) + sum over k of a_k psi_k(s)
///
/// keeps its mean whatever the a_k, and their squares add up to the mean square of the departure.
class AcrossModes {
 public:
  /// @param shape   g, 0 at the sides.
  /// @param n_even  polynomials (1 - s^2) P_2k(s), k = 0 .. n_even, less their means; one less
  ///                remains where they hold g itself.
  /// @param n_odd   polynomials (1 - s^2) P_2k+1(s), k < n_odd.
  AcrossModes(const flow::WallShape& shape, Index n_even, Index n_odd);

  Index n_even() const { return n_even_; }  ///< departures
  Index n_odd() const { return powers_.cols() - 1 - n_even_; }
  Index size() const { return powers_.cols() - 1; }  ///< departures, even and odd

  /// Values at positions s: (n, 1 + size).
  Matrix at(const Array1& s) const;
  /// Slopes d/ds there: (n, 1 + size).
  Matrix slopes(const Array1& s) const;
  /// Means between neighbouring edges s: (n - 1, 1 + size).
  Matrix means(const Array1& edges) const;

 private:
  Index n_even_ = 0;
  Matrix powers_;  ///< (degree + 1, 1 + size): coefficients of 1, s, s^2, ..
};

}  // namespace manoscope::validation
