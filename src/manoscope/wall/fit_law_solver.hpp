#pragma once

#include <functional>

#include "manoscope/core/arrays.hpp"

namespace manoscope::wall {

/// A curve y(x; theta) to be fitted where x and y both carry errors.
struct LatentFit {
  /// Gives y and dy/dx at (n) abscissae for (k) parameters; false where the curve does not exist.
  std::function<bool(const Array1& theta, const Array1& x, Array1& y, Array1& slope)> curve;
  Array1 x, sigma_x, y, sigma_y;  ///< (n); sigma_x may be 0
  Array1 start, lower, upper;     ///< (k)
  Array1 step;                    ///< (k) of the central differences by theta
  int max_iterations = 200;
};

struct LatentAnswer {
  Array1 theta;        ///< (k)
  Array1 x;            ///< (n) most likely true abscissae
  Array1 residual;     ///< (n) signed; sum of squares is the least chi2
  Matrix information;  ///< (k, k) of theta, true abscissae marginalised
  bool converged = false;
};

/// Least squares over theta and the true abscissae (Ceres, dense QR, one thread).
LatentAnswer solve_latent_fit(const LatentFit& fit);

}  // namespace manoscope::wall
