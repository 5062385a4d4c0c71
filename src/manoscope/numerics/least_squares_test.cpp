// See nist_strd_test.cpp for NIST's reference problems.
#include "manoscope/numerics/least_squares.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <limits>

#include "manoscope/core/error.hpp"
#include "manoscope/core/random.hpp"

namespace manoscope::numerics {
namespace {

using Eigen::VectorXd;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// y = b_0 exp(-b_1 t) at 20 times with given errors of y.
LeastSquaresProblem decay(const VectorXd& errors) {
  const VectorXd t = VectorXd::LinSpaced(errors.size(), 0.0, 3.0);
  const VectorXd y = 2.0 * (-0.7 * t.array()).exp() + errors.array();
  LeastSquaresProblem problem;
  problem.n_residuals = errors.size();
  problem.start = (VectorXd(2) << 1.0, 1.0).finished();
  problem.residuals = [t, y](const VectorXd& b, VectorXd& residuals) {
    residuals = y.array() - b(0) * (-b(1) * t.array()).exp();
    return true;
  };
  return problem;
}

VectorXd normal_errors(std::uint64_t number, double sigma) {
  RandomStream random(3, "errors", number);
  VectorXd errors(20);
  for (Index i = 0; i < 20; ++i) errors(i) = sigma * random.normal();
  return errors;
}

TEST(FitLeastSquares, AgreesWithTheNormalEquationsOfAPolynomial) {
  const VectorXd t = VectorXd::LinSpaced(12, -1.0, 1.0);
  Matrix design(12, 3);
  design << VectorXd::Ones(12), t, t.cwiseAbs2();
  const VectorXd y = t.array().exp();
  LeastSquaresProblem problem;
  problem.n_residuals = 12;
  problem.start = VectorXd::Zero(3);
  problem.residuals = [&](const VectorXd& b, VectorXd& residuals) {
    residuals = y - design * b;
    return true;
  };
  const auto fit = fit_least_squares(problem);
  ASSERT_TRUE(fit && fit->covariance);
  const Matrix inverse = (design.transpose() * design).inverse();
  // Round-off times the condition of the normal equations, about 20.
  EXPECT_LT((fit->parameters - inverse * design.transpose() * y).norm(), 1e-13);
  EXPECT_LT((*fit->covariance - inverse).norm(), 1e-12);
  EXPECT_EQ(fit->n_dof, 9);
  EXPECT_NEAR(fit->residual_sigma(), (y - design * fit->parameters).norm() / 3.0, 1e-15);
}

TEST(FitLeastSquares, FindsTheSameWithGivenDerivatives) {
  LeastSquaresProblem problem = decay(normal_errors(0, 0.05));
  const auto by_differences = fit_least_squares(problem);
  const VectorXd t = VectorXd::LinSpaced(20, 0.0, 3.0);
  problem.jacobian = [&](const VectorXd& b, Matrix& jacobian) {
    const Eigen::ArrayXd fall = (-b(1) * t.array()).exp();
    jacobian.col(0) = -fall;
    jacobian.col(1) = b(0) * t.array() * fall;
    return true;
  };
  const auto by_derivatives = fit_least_squares(problem);
  ASSERT_TRUE(by_differences && by_derivatives);
  // Ridders' method leaves some 1e-12 of a derivative here, which moves the minimum as little.
  EXPECT_LT((by_differences->parameters - by_derivatives->parameters).norm(), 1e-11);
  EXPECT_LT((by_differences->jacobian - by_derivatives->jacobian).norm(),
            1e-11 * by_derivatives->jacobian.norm());
}

TEST(FitLeastSquares, HasPullsOfMeanZeroAndWidthOne) {
  constexpr int kExperiments = 2000;
  Eigen::Array2d sum = Eigen::Array2d::Zero(), squares = Eigen::Array2d::Zero();
  for (int i = 0; i < kExperiments; ++i) {
    const auto fit = fit_least_squares(decay(normal_errors(static_cast<std::uint64_t>(i), 0.02)));
    ASSERT_TRUE(fit && fit->covariance);
    const Eigen::Array2d pull = (fit->parameters.array() - Eigen::Array2d(2.0, 0.7)) /
                                (0.02 * fit->covariance->diagonal().array().sqrt());
    sum += pull;
    squares += pull.square();
  }
  for (Index j = 0; j < 2; ++j) {  // 4 sigma of 2000 pulls; a 1 % error is nearly linear
    EXPECT_NEAR(sum(j) / kExperiments, 0.0, 4.0 / std::sqrt(kExperiments));
    EXPECT_NEAR(squares(j) / kExperiments, 1.0, 4.0 * std::sqrt(2.0 / kExperiments));
  }
}

TEST(FitLeastSquares, KeepsWithinItsBounds) {
  LeastSquaresProblem problem = decay(VectorXd::Zero(20));
  problem.lower = (VectorXd(2) << -kInfinity, 0.9).finished();
  problem.upper = (VectorXd(2) << kInfinity, 1.5).finished();
  const auto fit = fit_least_squares(problem);
  ASSERT_TRUE(fit);
  EXPECT_DOUBLE_EQ(fit->parameters(1), 0.9);  // the free minimum is at 0.7
  const VectorXd t = VectorXd::LinSpaced(20, 0.0, 3.0);
  const Eigen::ArrayXd fall = (-0.9 * t.array()).exp(), y = 2.0 * (-0.7 * t.array()).exp();
  // The other parameter is then linear: round-off, and 1e-12 of derivatives by differences.
  EXPECT_NEAR(fit->parameters(0), (fall * y).sum() / fall.square().sum(), 1e-11);
}

TEST(FitLeastSquares, HasNoCovarianceWhereParametersCannotBeToldApart) {
  LeastSquaresProblem problem = decay(VectorXd::Zero(20));
  problem.start = VectorXd::Ones(3);
  problem.residuals = [inner = problem.residuals](const VectorXd& b, VectorXd& residuals) {
    return inner((VectorXd(2) << b(0) + b(2), b(1)).finished(), residuals);
  };
  const auto fit = fit_least_squares(problem);
  ASSERT_TRUE(fit);
  EXPECT_FALSE(fit->covariance);
  EXPECT_FALSE(fit->scaled_sigma());
  EXPECT_NEAR(fit->parameters(0) + fit->parameters(2), 2.0, 1e-6);
}

TEST(FitLeastSquares, StepsBackWhereResidualsDoNotExist) {
  // sqrt(b) = 0.1 from a start whose first steps lead below 0.
  LeastSquaresProblem problem;
  problem.n_residuals = 1;
  problem.start = VectorXd::Constant(1, 4.0);
  problem.residuals = [](const VectorXd& b, VectorXd& residuals) {
    if (b(0) < 0.0) return false;
    residuals(0) = std::sqrt(b(0)) - 0.1;
    return true;
  };
  const auto fit = fit_least_squares(problem);
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->parameters(0), 0.01, 1e-10);
  problem.start = VectorXd::Constant(1, -1.0);
  EXPECT_FALSE(fit_least_squares(problem));
}

TEST(FitLeastSquares, RefusesProblemsThatMakeNoSense) {
  const LeastSquaresProblem good = decay(VectorXd::Zero(20));
  LeastSquaresProblem bad = good;
  bad.n_residuals = 1;
  EXPECT_THROW(fit_least_squares(bad), InputError);
  bad = good;
  bad.lower = VectorXd::Zero(1);
  EXPECT_THROW(fit_least_squares(bad), InputError);
  bad = good;
  bad.lower = VectorXd::Constant(2, 1.5);
  bad.upper = VectorXd::Constant(2, 2.0);
  EXPECT_THROW(fit_least_squares(bad), InputError);
  LeastSquaresOptions options;
  options.max_iterations = 0;
  EXPECT_THROW(fit_least_squares(good, options), InputError);
  MultiStartOptions many;
  many.spread = 0.0;
  EXPECT_THROW(fit_from_many_starts(good, many), InputError);
}

/// A sine of unknown frequency: many local minima.
LeastSquaresProblem sine() {
  const VectorXd t = VectorXd::LinSpaced(40, 0.0, 10.0);
  LeastSquaresProblem problem;
  problem.n_residuals = 40;
  problem.start = (VectorXd(2) << 0.5, 2.0).finished();
  problem.residuals = [t](const VectorXd& b, VectorXd& residuals) {
    residuals = (3.0 * t.array()).sin() - b(0) * (b(1) * t.array()).sin();
    return true;
  };
  return problem;
}

TEST(FitFromManyStarts, LeavesALocalMinimumForTheLeastOne) {
  const auto one = fit_least_squares(sine());
  ASSERT_TRUE(one);
  EXPECT_GT(one->sum_of_squares, 1.0);  // frequency 2 is caught between side lobes
  const auto many = fit_from_many_starts(sine());
  ASSERT_TRUE(many);
  EXPECT_EQ(many->n_agreeing, 5);
  EXPECT_GT(many->n_starts, 5);
  EXPECT_NEAR(many->best.parameters(0), 1.0, 1e-10);
  EXPECT_NEAR(many->best.parameters(1), 3.0, 1e-10);  // not -1 and -3, farther from the start
}

TEST(FitFromManyStarts, GivesTheSameBitsAgain) {
  const auto one = fit_from_many_starts(sine()), other = fit_from_many_starts(sine());
  ASSERT_TRUE(one && other);
  EXPECT_EQ(one->best.parameters, other->best.parameters);
  EXPECT_EQ(one->n_starts, other->n_starts);
}

TEST(FitFromManyStarts, GivesNoneWhereResidualsExistNowhere) {
  LeastSquaresProblem problem = sine();
  problem.residuals = [](const VectorXd&, VectorXd&) { return false; };
  EXPECT_FALSE(fit_from_many_starts(problem));
}

}  // namespace
}  // namespace manoscope::numerics
