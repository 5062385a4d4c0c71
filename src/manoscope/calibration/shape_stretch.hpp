#pragma once

#include <Eigen/Core>

#include "manoscope/core/index.hpp"

namespace manoscope::calibration {

/// Most bins across that the check takes: its matrices need no heap.
inline constexpr int kMostBins = 32;
using BinVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMostBins, 1>;

/// One stretch of a map against the shape that the levels give it.
///
///   r = zeta - model = a phi + b dzeta/dz + sum_m c_m e_m + noise
///
/// phi, the change of the shape with its average, and dzeta/dz, a shift across, are free: the
/// average was taken from the map itself, and maps lie where they do. e_m are the even polynomials
/// up to the sixth degree, orthonormal; their coefficients are known to be within about `smooth`
/// (root mean square over the bins) of 0: what non-uniform pressure, interpolation between levels
/// and the map's place along the flow do to the shape.
struct StretchShape {
  BinVector z;          ///< (n) 2 z / w of the good bins, within (-1, 1)
  BinVector residual;   ///< (n) m
  BinVector sigma;      ///< (n) m, standard, of the noise of map and levels
  BinVector phi;        ///< (n) d zeta / d average
  BinVector slope;      ///< (n) d zeta / d (2 z / w), m
  double smooth = 0.0;  ///< m
};

/// What the noise does not explain.
struct StretchMisfit {
  double chi_square = 0.0;
  /// Number of bins, less one for each of phi and the shift across, less the shares of the even
  /// polynomials that their freedom takes: what chi_square is on average without any misfit.
  double dof = 0.0;
  /// m, root mean square: the variance beyond the noise. 0 if there is none.
  double excess = 0.0;
};

StretchMisfit stretch_misfit(const StretchShape& shape);

/// By how much a foreign deformation of few bins has moved the average, m.
///
/// Fits r by phi, the shift and the polynomials with the weight of a bin falling as its distance
/// grows (Huber's with k = 1, then Cauchy's with 3), so that the bins without the deformation rule;
/// the deformation is what is left, and its mean over the bins has moved the average.
double moved_average(const StretchShape& shape);

/// The even polynomials 1, z^2, z^4, z^6 made orthogonal over the points, root mean square 1: (n,
/// 4).
Eigen::Matrix<double, Eigen::Dynamic, 4, 0, kMostBins, 4> even_polynomials(const BinVector& z);

}  // namespace manoscope::calibration
