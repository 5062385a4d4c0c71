#include "manoscope/inversion/curvature_fit.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "manoscope/core/random.hpp"

namespace manoscope::inversion {
namespace {

constexpr Index kRows = 24;
constexpr double kNoise = 5.0, kShared = 8.0;  // Pa

/// Windows with curvatures that fall off from both ends, a level and a slope that nobody knows, and
/// a shape whose size is 1 +- 0.5; noise of each, and one error that all share.
CurvatureRows rows() {
  CurvatureRows rows;
  const Array1 s = Array1::LinSpaced(kRows, 0.0, 1.0);
  rows.curvature = (10.0 * (-s / 0.1).exp() - 6.0 * (-(1.0 - s) / 0.1).exp()).matrix();
  rows.nuisance.resize(kRows, 3);
  rows.nuisance << Eigen::VectorXd::Ones(kRows), 1e4 * s.matrix(), 30.0 * (4.0 * s).sin().matrix();
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  rows.prior = Eigen::Vector3d(0.0, 0.0, 1.0);
  rows.prior_sigma = Eigen::Vector3d(kInfinite, kInfinite, 0.5);
  rows.target_effect = Matrix::Zero(kRows, kRows + 1);
  rows.target_effect.leftCols(kRows).diagonal().setConstant(kNoise);
  rows.target_effect.col(kRows) = (kShared * (7.0 * s).cos()).matrix();
  rows.curvature_effect = Matrix::Zero(kRows, kRows + 1);
  return rows;
}

/// Targets of a law with that b, with every error drawn.
void draw(CurvatureRows& rows, double b, RandomStream& random) {
  Eigen::VectorXd errors(kRows + 1);
  for (double& error : errors) error = random.normal();
  const Eigen::Vector3d size(4000.0, -0.3, 1.0 + 0.5 * random.normal());
  rows.target = rows.nuisance * size + b * rows.curvature + rows.target_effect * errors;
}

TEST(CurvatureFit, HasPullsOfMeanZeroAndWidthOne) {
  constexpr int kDraws = 2000;
  for (const double b : {0.0, -20.0}) {
    RandomStream random(11, "curvature fit");
    double sum = 0.0, squares = 0.0;
    int alarms = 0, misfits = 0;
    CurvatureRows drawn = rows();
    for (int i = 0; i < kDraws; ++i) {
      draw(drawn, b, random);
      const auto fit = fit_curvature(drawn);
      ASSERT_TRUE(fit.has_value());
      const double pull = (fit->b - b) / fit->uncertainty();
      sum += pull;
      squares += pull * pull;
      alarms += std::abs(pull) > 1.96 ? 1 : 0;
      misfits += fit->misfit > 0.0 ? 1 : 0;
    }
    // Four standard errors of each. Chance misfits, of which there are a few per cent, widen bars:
    // alarms may be a third fewer.
    EXPECT_NEAR(sum / kDraws, 0.0, 4.0 / std::sqrt(kDraws)) << b;
    EXPECT_NEAR(std::sqrt(squares / kDraws), 1.0, 4.0 / std::sqrt(2.0 * kDraws) + 0.03) << b;
    EXPECT_NEAR(alarms, 0.05 * kDraws, 4.0 * std::sqrt(0.05 * 0.95 * kDraws) + 0.015 * kDraws) << b;
    // Chi-square of 20 degrees of freedom is beyond its mean by 2 standard deviations in 3.7 %.
    EXPECT_NEAR(misfits, 0.037 * kDraws, 4.0 * std::sqrt(0.037 * kDraws)) << b;
  }
}

TEST(CurvatureFit, IsExactWithoutErrors) {
  CurvatureRows exact = rows();
  exact.target_effect.setZero();
  exact.target = exact.nuisance * Eigen::Vector3d(4000.0, -0.3, 1.0) - 20.0 * exact.curvature;
  const auto fit = fit_curvature(exact);
  ASSERT_TRUE(fit.has_value());
  EXPECT_NEAR(fit->b, -20.0, 1e-6);
  EXPECT_NEAR(fit->size[0], 4000.0, 1e-6);
  EXPECT_NEAR(fit->size[1], -0.3, 1e-8);
  EXPECT_EQ(fit->misfit, 0.0);
}

TEST(CurvatureFit, TellsHowFarTheLawIsOff) {
  // b differs from window to window, between -30 and -10: a standard deviation of 7.1 N/m.
  CurvatureRows off = rows();
  const Array1 b = -20.0 + 10.0 * (50.0 * Array1::LinSpaced(kRows, 0.0, 1.0)).sin();
  off.target_effect /= 100.0;
  off.target =
      off.nuisance * Eigen::Vector3d(4000.0, -0.3, 1.0) + (b * off.curvature.array()).matrix();
  const auto fit = fit_curvature(off);
  ASSERT_TRUE(fit.has_value());
  EXPECT_NEAR(fit->b, -20.0, 2.0 * fit->uncertainty());
  // Three or four windows hold most of the curvature: the standard deviation of so few.
  EXPECT_GT(fit->misfit, 0.4 * 7.1);
  EXPECT_LT(fit->misfit, 1.8 * 7.1);
  EXPECT_GE(fit->uncertainty(), fit->misfit);
}

TEST(CurvatureFit, CarriesErrorsThatMoveTargetAndCurvatureTogether) {
  // One error adds its shape to the curvature and b times it to the target: b stays what it was.
  CurvatureRows linked = rows();
  linked.target_effect.setZero();
  linked.target_effect.leftCols(kRows).diagonal().setConstant(0.1);
  const Eigen::VectorXd shape = Eigen::VectorXd::LinSpaced(kRows, 0.3, -0.1);
  linked.curvature_effect.col(kRows) = shape;
  linked.target_effect.col(kRows) = -20.0 * shape;
  linked.target = linked.nuisance * Eigen::Vector3d(4000.0, -0.3, 1.0) - 20.0 * linked.curvature;
  const auto fit = fit_curvature(linked);
  ASSERT_TRUE(fit.has_value());
  EXPECT_LT(std::abs(fit->effect[kRows]), 1e-6);
}

TEST(CurvatureFit, IsNoneWithTooFewWindowsOrWithoutCurvature) {
  CurvatureRows flat = rows();
  flat.target = Eigen::VectorXd::LinSpaced(kRows, 0.0, 1.0);
  flat.curvature.setZero();
  EXPECT_FALSE(fit_curvature(flat).has_value());
  CurvatureRows few = rows();
  few.target = flat.target;
  few.target.conservativeResize(5);
  few.curvature.conservativeResize(5);
  few.nuisance.conservativeResize(5, 3);
  few.target_effect.conservativeResize(5, kRows + 1);
  few.curvature_effect.conservativeResize(5, kRows + 1);
  EXPECT_FALSE(fit_curvature(few).has_value());
}

}  // namespace
}  // namespace manoscope::inversion
