#include "manoscope/twin/point_spread.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace manoscope::twin {
namespace {

TEST(PointSpread, WeightsHaveTheirVarianceAndSumForAnyWidth) {
  for (const double sigma : {0.05, 0.3, 0.7, 1.5, 3.99, 4.01, 12.0}) {
    const Array1 weights = gaussian_weights(sigma);
    const Index m = weights.size() / 2;
    double sum = 0.0, variance = 0.0;
    for (Index k = -m; k <= m; ++k) {
      sum += weights(k + m);
      variance += static_cast<double>(k * k) * weights(k + m);
    }
    EXPECT_NEAR(sum, 1.0, 1e-14);
    // The first weight left out on either side, at m + 1, is below 1e-8; those beyond add less than
    // as much again.
    const double left_out = 4.0 * static_cast<double>((m + 1) * (m + 1)) * 1e-8;
    EXPECT_NEAR(variance / (sigma * sigma), 1.0, left_out / (sigma * sigma)) << sigma;
  }
}

TEST(PointSpread, NoWidthIsNoBlur) {
  EXPECT_EQ(gaussian_weights(0.0).size(), 1);
  Array2 values = Array2::Random(5, 7);
  const Array2 before = values;
  blur(values, 0.0, 0.0);
  EXPECT_TRUE((values == before).all());
}

TEST(PointSpread, AWaveLosesWhatAGaussianTakesFromIt) {
  const Index n = 400;
  for (const double sigma : {0.6, 2.0, 5.0}) {
    const double period = 40.0, k = 2.0 * M_PI / period;
    Array2 values(n, n);
    for (Index iy = 0; iy < n; ++iy) {
      for (Index ix = 0; ix < n; ++ix) {
        values(iy, ix) = std::cos(k * (static_cast<double>(ix) + 0.5));  // even about both edges
      }
    }
    const double before = values(0, 0);
    blur(values, sigma, 3.0);
    // exp(-k^2 sigma^2/2), or exp(-sigma^2 (1 - cos k)) of the discrete law: apart by k^2/12.
    const double expected = std::exp(-0.5 * k * k * sigma * sigma);
    EXPECT_NEAR(values(0, 0) / before, expected, 0.5 * k * k * sigma * sigma * k * k / 12.0 + 2e-8);
    EXPECT_NEAR(values(n / 2, 0) / before, values(0, 0) / before, 1e-12);  // uniform across
  }
}

TEST(PointSpread, KeepsTheMean) {
  Array2 values = Array2::Random(31, 57);
  const double mean = values.mean();
  blur(values, 2.5, 1.2);
  EXPECT_NEAR(values.mean(), mean, 1e-14);
}

TEST(CorrelatedNoise, HasUnitVarianceUpToTheEdgesAndTheStatedCorrelation) {
  const double l_x = 8.0, l_y = 5.0;
  const Index ny = 200, nx = 400;
  double variance = 0.0, edge = 0.0, along = 0.0, across = 0.0;
  const int n_maps = 12;
  for (int map = 0; map < n_maps; ++map) {
    RandomStream random(3, "correlated", static_cast<std::uint64_t>(map));
    const Array2 noise = correlated_noise(ny, nx, l_x, l_y, random);
    variance += noise.square().mean() / n_maps;
    edge += noise.col(0).square().mean() / n_maps;
    along += (noise.leftCols(nx - 8) * noise.rightCols(nx - 8)).mean() / n_maps;
    across += (noise.topRows(ny - 5) * noise.bottomRows(ny - 5)).mean() / n_maps;
  }
  // Five standard errors: squares of one map are correlated over an area of pi l_x l_y / 2, so
  // that a map holds 200 * 400 / 63 independent ones; a column, 200 / (1.25 l_y) = 32.
  const double n = n_maps * 200.0 * 400.0 / 63.0;
  EXPECT_NEAR(variance, 1.0, 5.0 * std::sqrt(2.0 / n));
  EXPECT_NEAR(edge, 1.0, 5.0 * std::sqrt(2.0 / (n_maps * 32.0)));
  EXPECT_NEAR(along, std::exp(-1.0), 5.0 * std::sqrt(2.0 / n));
  EXPECT_NEAR(across, std::exp(-1.0), 5.0 * std::sqrt(2.0 / n));
}

TEST(CorrelatedNoise, WithoutLengthIsWhite) {
  RandomStream one(3, "white"), two(3, "white");
  const Array2 noise = correlated_noise(20, 30, 0.0, 0.0, one);
  for (Index i = 0; i < noise.size(); ++i) EXPECT_EQ(noise.data()[i], two.normal());
}

}  // namespace
}  // namespace manoscope::twin
