#pragma once

#include <array>
#include <utility>
#include <vector>

#include "manoscope/core/index.hpp"

namespace manoscope::numerics {

/// Cubic Hermite interpolant that keeps the shape of its data: monotone between neighbouring knots
/// wherever they are, no overshoot, C1.
///
/// The slope at a knot is that of the parabola u(y) through it and its neighbours (as for PCHIP a
/// harmonic mean of the secants on both sides, here weighted by the rises), at most three times the
/// smaller secant, 0 at a turning point; the limits are the sufficient ones of Fritsch & Carlson
/// (SIAM J. Numer. Anal. 17, 238, 1980). The inverse parabola suits curves y(u) whose inverse is a
/// polynomial, such as the deflection of a stretching wall under pressure: it follows a steep
/// start, and where a curve turns from steep to flat within two knots it sides with the flat
/// secant, which keeps noise of one knot from swinging its neighbours. For smooth monotone data the
/// error is O(h^3).
class ShapeSpline {
 public:
  /// @param u  knots, strictly ascending, at least 2.
  /// @param y  values, as many.
  /// @throws InternalError if they are not.
  ShapeSpline(std::vector<double> u, std::vector<double> y);

  Index size() const { return static_cast<Index>(u_.size()); }
  double knot(Index j) const { return u_[static_cast<std::size_t>(j)]; }
  double knot_value(Index j) const { return y_[static_cast<std::size_t>(j)]; }
  double knot_slope(Index j) const { return d_[static_cast<std::size_t>(j)]; }

  /// Value and derivative at u in [first knot, last knot].
  double value(double u) const;
  double derivative(double u) const;

  /// How far another fair interpolant lies from this one: the same with the slopes of the parabola
  /// through three knots, limited to three times the smaller secant (Fritsch & Carlson 1980). A
  /// measure of the interpolation error, signed; 0 at the knots.
  double doubt(double u) const;

  /// Every u with value(u) = y, ascending; a flat stretch at y gives its middle.
  std::vector<double> solve(double y) const;

  /// d value(u) / d y_j for the few knots j that matter: (j, derivative).
  std::vector<std::pair<Index, double>> weights(double u) const;

  /// d value(u) / d u_j for the same few knots: what moving a knot along u does. Moving all of them
  /// together moves the curve, so the derivatives sum to -derivative(u). By central differences of
  /// the interpolant itself, in steps of 1e-6 of the nearest distance of knots.
  std::vector<std::pair<Index, double>> knot_weights(double u) const;

 private:
  Index interval(double u) const;

  std::vector<double> u_, y_, d_;
  std::vector<double> other_d_;  ///< slopes of the other interpolant
  /// d d_j / d y_i over the three knots i that start at first_j.
  std::vector<Index> first_;
  std::vector<std::array<double, 3>> stencil_;
};

}  // namespace manoscope::numerics
