#include "manoscope/inversion/curvature_fit.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace manoscope::inversion {
namespace {

constexpr Index kSpareRows = 3;
constexpr int kPasses = 4;
constexpr double kMisfitCounts = 2.0;  // standard deviations of chi-square
constexpr double kFloor = 1e-5;        // of the targets' range: exact data have a covariance, too

/// The estimate at one covariance.
struct Solution {
  double b;
  Eigen::VectorXd size;  ///< (k)
  Eigen::VectorXd gain;  ///< (n) of b by the targets
  double variance;       ///< of b
  double chi2;
};

/// Mean products of the errors of the windows.
struct ErrorProducts {
  Matrix target, both, curvature;  ///< (n, n); both: of target by row and curvature by column

  explicit ErrorProducts(const CurvatureRows& rows)
      : target(rows.target_effect * rows.target_effect.transpose()),
        both(rows.target_effect * rows.curvature_effect.transpose()),
        curvature(rows.curvature_effect * rows.curvature_effect.transpose()) {}
  /// Of target - b curvature.
  Matrix covariance(double b, double floor) const {
    Matrix sum = target - b * (both + both.transpose()) + b * b * curvature;
    sum.diagonal().array() += floor * floor;
    return sum;
  }
};

/// Rows turned into the axes of their errors, where every misfit leaves them independent.
class Solver {
 public:
  Solver(const CurvatureRows& rows, const ErrorProducts& errors, double b, double floor)
      : axes_(errors.covariance(b, floor)) {
    const Matrix turn = axes_.eigenvectors().transpose();
    const Index k = rows.nuisance.cols();
    // Columns of one length: their sizes differ by many orders.
    length_ = rows.nuisance.colwise().norm().transpose();
    nuisance_ = turn * rows.nuisance * length_.cwiseInverse().asDiagonal();
    curvature_ = turn * rows.curvature;
    target_ = turn * rows.target;
    prior_ = information_ = Eigen::VectorXd::Zero(k);
    for (Index j = 0; j < k; ++j) {
      if (!std::isfinite(rows.prior_sigma[j])) continue;
      information_[j] = std::pow(rows.prior_sigma[j] * length_[j], -2);
      prior_[j] = rows.prior[j] * length_[j];
    }
    both_ = turn * errors.both * turn.transpose();
    blur_ = turn * errors.curvature * turn.transpose();
  }
  double n_free() const { return static_cast<double>(target_.size() - nuisance_.cols() - 1); }

  std::optional<Solution> solve(double misfit) const {
    constexpr double kLeastCondition = 1e-13;
    const Index n = target_.size(), k = nuisance_.cols();
    const Eigen::VectorXd weight =
        (axes_.eigenvalues().array().max(0.0) + misfit * misfit).inverse().matrix();
    // What the nuisance cannot explain: targets and curvature count by this form alone.
    Matrix form = weight.asDiagonal();
    Matrix fitted = Matrix::Zero(k, n);
    if (k > 0) {
      const Matrix weighted = weight.asDiagonal() * nuisance_;
      Matrix normal = nuisance_.transpose() * weighted;
      normal.diagonal() += information_;
      const Eigen::LLT<Matrix> inverse(normal);
      if (inverse.info() != Eigen::Success || !(inverse.rcond() > kLeastCondition)) {
        return std::nullopt;
      }
      fitted = inverse.solve(weighted.transpose());
      form -= weighted * fitted;
    }
    const Eigen::VectorXd target = target_ - nuisance_ * prior_, seen = form * curvature_;
    const double curved = seen.dot(curvature_), blur = form.cwiseProduct(blur_).sum();
    if (!(curved > 2.0 * blur)) return std::nullopt;
    Solution solution;
    solution.b = (seen.dot(target) - form.cwiseProduct(both_).sum()) / (curved - blur);
    const Eigen::VectorXd left = target - solution.b * curvature_;
    solution.size = (prior_ + fitted * left).cwiseQuotient(length_);
    solution.gain = axes_.eigenvectors() * seen / (curved - blur);
    solution.variance = curved / ((curved - blur) * (curved - blur));
    solution.chi2 = left.dot(form * left);
    return solution;
  }

 private:
  Eigen::SelfAdjointEigenSolver<Matrix> axes_;
  Matrix nuisance_, both_, blur_;
  Eigen::VectorXd target_, curvature_, length_, prior_, information_;
};

/// The misfit, Pa, that brings chi-square to its mean; 0 where errors may explain what is left.
double find_misfit(const Solver& solver, double largest) {
  constexpr double kNear = 1.01;
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
  const ErrorProducts errors(rows);
  CurvatureFit fit;
  std::optional<Solution> solution;
  double misfit = 0.0;
  for (int pass = 0; pass < kPasses; ++pass) {
    const Solver solver(rows, errors, fit.b, kFloor * range);
    // Before b is known nothing tells what errors of the curvature do: equal weights first.
    misfit = pass == 0 ? range : find_misfit(solver, range);
    solution = solver.solve(misfit);
    if (!solution) return std::nullopt;
    fit.b = solution->b;
  }
  fit.size = solution->size;
  fit.effect = (rows.target_effect - fit.b * rows.curvature_effect).transpose() * solution->gain;
  fit.noise = std::sqrt(solution->variance);
  fit.misfit = misfit * std::sqrt(static_cast<double>(n) / rows.curvature.squaredNorm());
  constexpr double kLeastBlur = 1e-300;
  fit.clearness = std::sqrt(rows.curvature.squaredNorm() /
                            std::max(rows.curvature_effect.squaredNorm(), kLeastBlur));
  return fit;
}

}  // namespace manoscope::inversion
