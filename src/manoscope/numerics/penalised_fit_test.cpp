#include "manoscope/numerics/penalised_fit.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "manoscope/core/random.hpp"
#include "manoscope/numerics/natural_spline.hpp"

namespace manoscope::numerics {
namespace {

constexpr Index kNodes = 20, kData = 200;
constexpr double kNoise = 0.3;

struct Problem {
  NaturalSpline spline{Array1::LinSpaced(kNodes, 0.0, 1.0)};
  Array1 x = Array1::LinSpaced(kData, 0.0, 1.0);
  Matrix model = spline.sampling(x) * spline.from_coefficients();

  Penalty penalty() const {
    Penalty made{spline.roughness(Array1::Ones(kNodes - 2)), 0.0, kNodes - 2};
    const Matrix part = made.matrix.bottomRightCorner(kNodes - 2, kNodes - 2);
    made.log_determinant =
        Eigen::SelfAdjointEigenSolver<Matrix>(part).eigenvalues().array().log().sum();
    return made;
  }
  NormalEquations equations(const Eigen::VectorXd& y) const {
    const double w = 1.0 / (kNoise * kNoise);
    return {w * model.transpose() * model, w * model.transpose() * y, w * y.squaredNorm()};
  }
};

TEST(PenalisedFit, WithAHugeWeightIsTheStraightLineThroughTheData) {
  const Problem problem;
  Eigen::VectorXd y = (2.0 + 3.0 * problem.x).matrix();
  y[50] += 1.0;
  const auto fit = fit_penalised(problem.equations(y), {problem.penalty()}, WeightRange{1e12, 0});
  EXPECT_LT(fit.coefficients.tail(kNodes - 2).cwiseAbs().maxCoeff(), 1e-8);
  // Ordinary least squares of a line, by its two sums.
  const double mean_x = problem.x.mean(), mean_y = y.mean();
  const double slope =
      ((problem.x - mean_x) * (y.array() - mean_y)).sum() / (problem.x - mean_x).square().sum();
  EXPECT_NEAR(2.0 * fit.coefficients[1], slope, 1e-9);
}

TEST(PenalisedFit, FindsTheWeightOfThePriorThatDataWereDrawnFrom) {
  // c^T P c weight is chi-square of 18: its logarithm is known to sqrt(2/18) = 0.33, steps are 1.
  const Problem problem;
  const Penalty penalty = problem.penalty();
  const Matrix part = penalty.matrix.bottomRightCorner(kNodes - 2, kNodes - 2);
  const Eigen::LLT<Matrix> factors(part);
  constexpr double kTrue = 1e-4;
  double sum = 0.0;
  constexpr int kTrials = 40;
  double pulls = 0.0;
  for (int trial = 0; trial < kTrials; ++trial) {
    RandomStream stream(7, "penalised fit", static_cast<std::uint64_t>(trial));
    Eigen::VectorXd unit(kNodes - 2), truth = Eigen::VectorXd::Zero(kNodes);
    for (Index i = 0; i < unit.size(); ++i) unit[i] = stream.normal();
    truth.tail(kNodes - 2) = factors.matrixU().solve(unit) / std::sqrt(kTrue);
    Eigen::VectorXd y = problem.model * truth;
    for (Index i = 0; i < kData; ++i) y[i] += kNoise * stream.normal();
    const auto fit =
        fit_penalised(problem.equations(y), {penalty}, WeightRange{1e-4 * std::exp(-8.0), 16});
    sum += std::log(fit.weight / kTrue);
    const Eigen::VectorXd off = problem.model * (fit.coefficients - truth);
    const Eigen::VectorXd variance =
        (problem.model * fit.covariance * problem.model.transpose()).diagonal();
    pulls += (off.array().square() / variance.array()).mean();
    // y - J c of 200 data and at most 20 coefficients.
    EXPECT_NEAR(fit.misfit, kData, 5.0 * std::sqrt(2.0 * kData) + kNodes);
  }
  // The mean over 40 trials, five standard errors of the likelihood's own scatter of about 0.6.
  EXPECT_NEAR(sum / kTrials, 0.0, 0.5);
  // Mean square of the pulls: about 8 effective coefficients a trial, 5 standard errors.
  EXPECT_NEAR(pulls / kTrials, 1.0, 5.0 * std::sqrt(2.0 / (8.0 * kTrials)));
}

TEST(PenalisedFit, PrefersThePenaltyUnderWhichTheDataAreLikely) {
  // A kink at the left end alone: a prior that allows roughness there explains it better.
  const Problem problem;
  Array1 soft = Array1::Ones(kNodes - 2);
  for (Index i = 0; i < 4; ++i) soft[i] = 1e-4;
  Penalty ends{problem.spline.roughness(soft), 0.0, kNodes - 2};
  ends.log_determinant = problem.penalty().log_determinant + soft.log().sum();
  Eigen::VectorXd kinked(kData), even(kData);
  RandomStream stream(11, "kink", 0);
  for (Index i = 0; i < kData; ++i) {
    const double noise = kNoise * stream.normal();
    kinked[i] = 40.0 * std::exp(-problem.x[i] / 0.05) + noise;
    even[i] = 4.0 * std::sin(20.0 * problem.x[i]) + noise;
  }
  const std::vector<Penalty> both{problem.penalty(), ends};
  const WeightRange range{1e-10, 30};
  EXPECT_EQ(fit_penalised(problem.equations(kinked), both, range).penalty, 1U);
  EXPECT_EQ(fit_penalised(problem.equations(even), both, range).penalty, 0U);
}

}  // namespace
}  // namespace manoscope::numerics
