#include "manoscope/numerics/penalised_fit.hpp"

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>

#include "manoscope/core/error.hpp"

namespace manoscope::numerics {
namespace {

/// Cholesky factors of a matrix scaled to a unit diagonal.
class ScaledFactors {
 public:
  explicit ScaledFactors(const Matrix& matrix)
      : scale_(matrix.diagonal().cwiseSqrt().cwiseInverse()),
        factors_(Matrix(scale_.asDiagonal() * matrix * scale_.asDiagonal())) {}

  bool definite() const { return factors_.info() == Eigen::Success; }
  Eigen::VectorXd solve(const Eigen::VectorXd& right) const {
    return scale_.cwiseProduct(factors_.solve(scale_.cwiseProduct(right)));
  }
  Matrix inverse() const {
    return scale_.asDiagonal() * factors_.solve(Matrix(scale_.asDiagonal()));
  }
  double log_determinant() const {
    return 2.0 * Matrix(factors_.matrixL()).diagonal().array().log().sum() -
           2.0 * scale_.array().log().sum();
  }

 private:
  Eigen::VectorXd scale_;
  Eigen::LLT<Matrix> factors_;
};

}  // namespace

PenalisedFit fit_penalised(const NormalEquations& data, const std::vector<Penalty>& penalties,
                           const WeightRange& weights) {
  MANO_ASSERT(!penalties.empty() && weights.smallest > 0.0);
  PenalisedFit best;
  double best_likelihood = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < penalties.size(); ++i) {
    const Penalty& penalty = penalties[i];
    for (int step = 0; step <= weights.n_steps; ++step) {
      const double weight = weights.smallest * std::exp(step);
      const ScaledFactors factors(data.matrix + weight * penalty.matrix);
      if (!factors.definite()) continue;
      const Eigen::VectorXd solution = factors.solve(data.right);
      const double likelihood =
          0.5 * (data.right.dot(solution) - data.square - factors.log_determinant() +
                 penalty.log_determinant + static_cast<double>(penalty.rank) * std::log(weight));
      if (!(likelihood > best_likelihood)) continue;
      best_likelihood = likelihood;
      best.coefficients = solution;
      best.weight = weight;
      best.penalty = i;
    }
  }
  MANO_ASSERT(std::isfinite(best_likelihood));
  best.covariance =
      ScaledFactors(data.matrix + best.weight * penalties[best.penalty].matrix).inverse();
  best.misfit = data.square - 2.0 * data.right.dot(best.coefficients) +
                best.coefficients.dot(data.matrix * best.coefficients);
  return best;
}

}  // namespace manoscope::numerics
