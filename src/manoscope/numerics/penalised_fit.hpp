#pragma once

#include <vector>

#include "manoscope/core/arrays.hpp"

namespace manoscope::numerics {

/// A linear model y = J c + e of independent errors with known variances, as normal equations.
struct NormalEquations {
  Matrix matrix;          ///< (n, n) J^T V^-1 J
  Eigen::VectorXd right;  ///< (n) J^T V^-1 y
  double square = 0.0;    ///< y^T V^-1 y
};

/// A quadratic penalty on coefficients, known up to a factor.
struct Penalty {
  Matrix matrix;                 ///< (n, n), positive semi-definite
  double log_determinant = 0.0;  ///< of its non-zero part
  Index rank = 0;
};

/// Weights of the penalty that are tried: smallest * e^0, e^1 ... e^n_steps.
struct WeightRange {
  double smallest = 0.0;
  int n_steps = 24;
};

struct PenalisedFit {
  Eigen::VectorXd coefficients;
  Matrix covariance;        ///< (n, n) of the posterior: (matrix + weight penalty)^-1
  double weight = 0.0;      ///< of the penalty
  std::size_t penalty = 0;  ///< which of those given
  double misfit = 0.0;      ///< chi-square of the data
};

/// Minimises  |y - J c|^2_V + weight c^T P c  with the penalty and the weight that make the data
/// most likely.
///
/// The penalty is the prior that c^T P c times the weight is a chi-square of the penalty's rank;
/// the likelihood is that of the data with c integrated out, coefficients without a prior included
/// (restricted maximum likelihood; Wahba, Spline Models for Observational Data, 1990, ch. 4). The
/// covariance is that of the posterior given penalty and weight: for smooth truths its intervals
/// cover on average over positions (Wahba 1983), not at each.
///
/// @param penalties  at least one, whose null space the data determine.
/// @throws InternalError where no weight gives a definite matrix.
PenalisedFit fit_penalised(const NormalEquations& data, const std::vector<Penalty>& penalties,
                           const WeightRange& weights);

}  // namespace manoscope::numerics
