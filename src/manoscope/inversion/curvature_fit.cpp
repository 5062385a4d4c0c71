#include "manoscope/inversion/curvature_fit.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace manoscope::inversion {
namespace {

constexpr Index kSpareRows = 3;
constexpr int kPasses = 3;
constexpr double kMisfitCounts = 2.0;  // standard deviations of chi-square
constexpr double kFloor = 1e-5;        // of the targets' range: exact data have a covariance, too

/// The estimate at one covariance.
struct Solution {
  Eigen::VectorXd parameters;  ///< (k + 1), b last
  Eigen::VectorXd gain;        ///< (n) of b by the targets
  double variance;             ///< of b
  double chi2;
};

/// Rows turned into the axes of their errors, where every misfit leaves them independent.
class Solver {
 public:
  Solver(const CurvatureRows& rows, const Matrix& noise) : axes_(noise) {
    const Index k = rows.nuisance.cols();
    Matrix model(rows.target.size(), k + 1);
    model << rows.nuisance, rows.curvature;
    // Columns of one length: their sizes differ by many orders.
    length_ = model.colwise().norm().transpose();
    model_ = axes_.eigenvectors().transpose() * model * length_.cwiseInverse().asDiagonal();
    target_ = axes_.eigenvectors().transpose() * rows.target;
    prior_ = information_ = Eigen::VectorXd::Zero(k + 1);
    for (Index j = 0; j < k; ++j) {
      if (!std::isfinite(rows.prior_sigma[j])) continue;
      information_[j] = std::pow(rows.prior_sigma[j] * length_[j], -2);
      prior_[j] = rows.prior[j] * length_[j];
    }
  }
  double n_free() const { return static_cast<double>(model_.rows() - model_.cols()); }

  std::optional<Solution> solve(double misfit) const {
    constexpr double kLeastCondition = 1e-13;
    const Index k = model_.cols() - 1;
    const Eigen::VectorXd weight =
        (axes_.eigenvalues().array().max(0.0) + misfit * misfit).inverse().matrix();
    const Matrix weighted = weight.asDiagonal() * model_;
    Matrix normal = model_.transpose() * weighted;
    normal.diagonal() += information_;
    const Eigen::LLT<Matrix> inverse(normal);
    if (inverse.info() != Eigen::Success || !(inverse.rcond() > kLeastCondition)) {
      return std::nullopt;
    }
    const Eigen::VectorXd scaled =
        inverse.solve(weighted.transpose() * target_ + information_.cwiseProduct(prior_));
    const Eigen::VectorXd last = inverse.solve(Eigen::VectorXd::Unit(k + 1, k));
    const Eigen::VectorXd left = target_ - model_ * scaled, off = scaled - prior_;
    return Solution{scaled.cwiseQuotient(length_),
                    axes_.eigenvectors() * weighted * last / length_[k],
                    last[k] / (length_[k] * length_[k]),
                    left.dot(weight.cwiseProduct(left)) + off.dot(information_.cwiseProduct(off))};
  }

 private:
  Eigen::SelfAdjointEigenSolver<Matrix> axes_;
  Matrix model_;
  Eigen::VectorXd target_, length_, prior_, information_;
};

/// The misfit, Pa, that brings chi-square to its mean; 0 where errors may explain what is left.
double find_misfit(const Solver& solver, double largest) {
  constexpr double kNear = 1.001;
  const double n_free = solver.n_free();
  const auto chi2 = [&](double misfit) {
    const auto solution = solver.solve(misfit);
    return solution ? solution->chi2 : n_free;
  };
  if (chi2(0.0) <= n_free + kMisfitCounts * std::sqrt(2.0 * n_free)) return 0.0;
  double low = kFloor * largest, high = largest;
  while (high > kNear * low) {
    const double middle = std::sqrt(low * high);
    (chi2(middle) > n_free ? low : high) = middle;
  }
  return high;
}

}  // namespace

double CurvatureFit::uncertainty() const { return std::hypot(noise, misfit); }

std::optional<CurvatureFit> fit_curvature(const CurvatureRows& rows) {
  const Index n = rows.target.size(), k = rows.nuisance.cols();
  if (n < k + kSpareRows) return std::nullopt;
  const double range = rows.target.maxCoeff() - rows.target.minCoeff();
  const bool has_shapes = rows.curvature.norm() > 0.0 && range > 0.0 &&
                          (rows.nuisance.colwise().squaredNorm().array() > 0.0).all();
  if (!has_shapes) return std::nullopt;
  CurvatureFit fit;
  std::optional<Solution> solution;
  double misfit = 0.0;
  for (int pass = 0; pass < kPasses; ++pass) {
    const Matrix effect = rows.target_effect - fit.b * rows.curvature_effect;
    Matrix noise = effect * effect.transpose();
    noise.diagonal().array() += std::pow(kFloor * range, 2);
    const Solver solver(rows, noise);
    misfit = find_misfit(solver, range);
    solution = solver.solve(misfit);
    if (!solution) return std::nullopt;
    fit.b = solution->parameters[k];
    fit.effect = effect.transpose() * solution->gain;
  }
  fit.size = solution->parameters.head(k);
  fit.noise = std::sqrt(solution->variance);
  fit.misfit = misfit * std::sqrt(static_cast<double>(n) / rows.curvature.squaredNorm());
  constexpr double kLeastBlur = 1e-300;
  fit.clearness = std::sqrt(rows.curvature.squaredNorm() /
                            std::max(rows.curvature_effect.squaredNorm(), kLeastBlur));
  return fit;
}

}  // namespace manoscope::inversion
