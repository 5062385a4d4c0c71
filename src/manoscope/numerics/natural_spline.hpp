#pragma once

#include "manoscope/core/arrays.hpp"

namespace manoscope::numerics {

/// Natural cubic splines through given nodes, as matrices.
///
/// A spline is told by its n values at the nodes, or by n coefficients: its mean and slope, and its
/// second derivatives at the n - 2 inner nodes (0 at the outer two). The second form is the one to
/// smooth in: the roughness int g''^2 leaves the first two alone and weighs the others by a
/// well-conditioned band matrix.
///
/// Source: Green & Silverman, Nonparametric Regression and Generalized Linear Models (1994), ch. 2.
class NaturalSpline {
 public:
  /// @param nodes  (n), n >= 4, strictly ascending.
  explicit NaturalSpline(Array1 nodes);

  const Array1& nodes() const { return nodes_; }
  /// Values at positions from values at the nodes: (m, n). Straight beyond the outer nodes.
  Matrix sampling(const Array1& positions) const;
  /// Values at the nodes from coefficients: (n, n). Column 0 is 1, column 1 runs from -1 to 1.
  const Matrix& from_coefficients() const { return from_coefficients_; }
  /// Matrix of int stiffness g''^2 in the coefficients: (n, n), its first two rows and columns 0.
  /// @param stiffness  (n - 2) at the inner nodes, > 0.
  Matrix roughness(const Array1& stiffness) const;

 private:
  Array1 nodes_;
  Matrix mass_;       ///< (n - 2, n - 2): int of the products of hat functions
  Matrix curvature_;  ///< (n - 2, n): second derivatives from values
  Matrix from_coefficients_;
};

}  // namespace manoscope::numerics
