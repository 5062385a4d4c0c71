#include "manoscope/numerics/plane.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "manoscope/core/random.hpp"

namespace manoscope::numerics {
namespace {

std::vector<PlanePoint> noisy_plane(const Eigen::Vector3d& c, double sigma, int n,
                                    RandomStream& stream) {
  std::vector<PlanePoint> points;
  for (int i = 0; i < n; ++i) {
    const double a = stream.uniform(-1.0, 1.0), b = stream.uniform(-1.0, 1.0);
    points.push_back({a, b, c[0] + c[1] * a + c[2] * b + sigma * stream.normal()});
  }
  return points;
}

TEST(FitPlane, RecoversAnExactPlane) {
  RandomStream stream(1, "exact");
  const Eigen::Vector3d truth(1.0, -2.0, 0.5);
  const auto fit = fit_plane(noisy_plane(truth, 0.0, 100, stream));
  ASSERT_TRUE(fit);
  EXPECT_LT((fit->coefficient - truth).norm(), 1e-12);  // round-off
}

TEST(FitPlane, IgnoresAFifthOfThePointsBulgingToOneSide) {
  RandomStream stream(2, "bulge");
  const Eigen::Vector3d truth(1.0, -2.0, 0.5);
  auto points = noisy_plane(truth, 0.02, 5000, stream);
  for (std::size_t i = 0; i < points.size(); i += 5) points[i].v += 10.0 * stream.uniform();
  const auto fit = fit_plane(points);
  ASSERT_TRUE(fit);
  // Outliers within 4.7 sigma cannot be told from noise: 0.1/10 of a fifth, each pulling < 5 sigma.
  EXPECT_LT((fit->coefficient - truth).norm(), 5.0 * 0.02 / std::sqrt(4000.0) + 0.002 * 0.1);
}

TEST(FitPlane, StatesItsUncertaintyTruly) {
  RandomStream stream(3, "pulls");
  const Eigen::Vector3d truth(0.0, 1.0, 2.0);
  constexpr int kTrials = 400;
  Eigen::Vector3d squares = Eigen::Vector3d::Zero();
  for (int trial = 0; trial < kTrials; ++trial) {
    const auto fit = fit_plane(noisy_plane(truth, 0.1, 300, stream));
    ASSERT_TRUE(fit);
    const Eigen::Vector3d pull =
        (fit->coefficient - truth).cwiseQuotient(fit->covariance.diagonal().cwiseSqrt());
    squares += pull.cwiseAbs2();
  }
  // Pull width 1: 4 standard errors of a variance from 400 trials, and the 5 % (2.5 % in width)
  // that the biweight's efficiency costs.
  for (const double square : squares / kTrials) {
    EXPECT_NEAR(square, 1.0, 4.0 * std::sqrt(2.0 / kTrials) + 0.05);
  }
}

TEST(FitPlane, SaysWhenPointsLieOnALine) {
  std::vector<PlanePoint> points;
  for (int i = 0; i < 10; ++i) points.push_back({0.1 * i, 0.2 * i, 1.0});
  EXPECT_FALSE(fit_plane(points));
}

}  // namespace
}  // namespace manoscope::numerics
