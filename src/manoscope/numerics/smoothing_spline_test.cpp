#include "manoscope/numerics/smoothing_spline.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "manoscope/core/random.hpp"

namespace manoscope::numerics {
namespace {

constexpr Index kData = 400, kKnots = 243;

/// A slow bulge that rises steeply at both ends.
Array1 bulge(const Array1& x) {
  constexpr double kRise = 0.04;
  return 30.0 * (1.0 - 0.5 * x) * (1.0 - (-x / kRise).exp()) * (1.0 - ((x - 1.0) / kRise).exp());
}

NoisyValues noisy(const Array1& truth, const Array1& x, double sigma, std::uint64_t seed) {
  RandomStream stream(seed, "smoothing spline", 0);
  NoisyValues data{x, truth, Array1::Constant(x.size(), sigma)};
  for (double& value : data.y) value += sigma * stream.normal();
  return data;
}

/// One beyond each end, where the spline has no second derivative.
Array1 knots() {
  constexpr double kStep = 1.0 / (kKnots - 3);
  return Array1::LinSpaced(kKnots, -kStep, 1.0 + kStep);
}
std::vector<Array1> bends() {
  const Array1 inner = knots().segment(1, kKnots - 2);
  const Array1 ends = (-inner / 0.04).exp() + ((inner - 1.0) / 0.04).exp();
  return {Array1::Ones(kKnots - 2), 1.0 + 30.0 * ends, 1.0 + 300.0 * ends, 1.0 + 3000.0 * ends};
}

TEST(SmoothingSpline, RecoversACurveWithinItsStatedUncertainty) {
  const Array1 x = Array1::LinSpaced(kData, 0.0, 1.0), truth = bulge(x);
  for (const double sigma : {1e-3, 0.03, 1.0}) {
    double square = 0.0, pull = 0.0;
    constexpr int kTrials = 8;
    for (int trial = 0; trial < kTrials; ++trial) {
      const SmoothingSpline smooth(noisy(truth, x, sigma, static_cast<std::uint64_t>(trial)),
                                   knots(), bends(), 0.02);
      const Array1 error = smooth.value(x) - truth;
      square += error.square().mean() / kTrials;
      pull += (error / smooth.standard(x)).square().mean() / kTrials;
    }
    // Below the noise, and what the standard uncertainty says: mean square pull 1 on average over
    // x, known to about sqrt(2/(8 curves * 20 degrees of freedom)) = 0.11 and 20 % of bias.
    EXPECT_LT(std::sqrt(square), 0.7 * sigma) << sigma;
    EXPECT_GT(pull, 0.6) << sigma;
    EXPECT_LT(pull, 1.4) << sigma;
  }
}

TEST(SmoothingSpline, TakesAwayNoMoreThanTheNoise) {
  // chi-square of 400 is known to sqrt(2 * 400) = 28; four times that is no chance.
  const Array1 x = Array1::LinSpaced(kData, 0.0, 1.0);
  for (const double sigma : {1e-3, 0.1, 3.0}) {
    for (const double waves : {1.0, 4.0}) {
      const Array1 truth = bulge(x) + 2.0 * (2.0 * std::numbers::pi * waves * x).sin();
      const SmoothingSpline smooth(noisy(truth, x, sigma, 5), knots(), bends(), 0.011);
      EXPECT_LT(smooth.misfit(), kData + 4.0 * 28.3) << sigma << ' ' << waves;
      const double taken = (smooth.value(x) - noisy(truth, x, sigma, 5).y).square().sum();
      EXPECT_NEAR(smooth.misfit() * sigma * sigma / taken, 1.0, 1e-9);
    }
  }
}

TEST(SmoothingSpline, KeepsHalfOfARippleOfItsWavelength) {
  const Array1 x = Array1::LinSpaced(kData, 0.0, 1.0);
  const NoisyValues data = noisy(bulge(x), x, 0.5, 3);
  const SmoothingSpline smooth(data, knots(), {Array1::Ones(kKnots - 2)}, 0.02);
  const double k = 2.0 * std::numbers::pi / smooth.half_wavelength();
  const Array1 ripple = (k * x).cos();
  const Array1 left = (smooth.weights(x) * ripple.matrix()).array();
  // Away from the ends, where the curve sees one side only.
  const auto inside = Eigen::seqN(kData / 4, kData / 2);
  const double share = (left(inside) * ripple(inside)).sum() / ripple(inside).square().sum();
  EXPECT_NEAR(share, 0.5, 0.02);
}

TEST(SmoothingSpline, IsLinearInTheData) {
  const Array1 x = Array1::LinSpaced(kData, 0.0, 1.0), at = Array1::LinSpaced(33, 0.01, 0.99);
  const NoisyValues data = noisy(bulge(x), x, 0.2, 9);
  const SmoothingSpline smooth(data, knots(), bends(), 0.02);
  const Array1 by_weights = (smooth.weights(at) * data.y.matrix()).array();
  EXPECT_LT((by_weights - smooth.value(at)).abs().maxCoeff(), 1e-7);
  // A straight line is as smooth as can be and comes through whole.
  const Array1 line = (smooth.weights(at) * (2.0 - 3.0 * x).matrix()).array();
  EXPECT_LT((line - (2.0 - 3.0 * at)).abs().maxCoeff(), 1e-7);
}

TEST(SmoothingSpline, StandsWhereAValueHasNextToNoError) {
  const Array1 x = Array1::LinSpaced(kData, 0.0, 1.0);
  NoisyValues data = noisy(bulge(x), x, 0.5, 4);
  data.y[0] = data.y[kData - 1] = 0.0;
  data.sigma[0] = data.sigma[kData - 1] = 1e-4;
  const SmoothingSpline smooth(data, knots(), bends(), 0.02);
  const Array1 ends = smooth.value(Array1{{0.0, 1.0}});
  EXPECT_LT(ends.abs().maxCoeff(), 4e-4);
}

TEST(SmoothingSpline, TakesMeansOverAWindowForWhatTheyAre) {
  // Means of a parabola over a window are off its values by a third of the square of half of it.
  const Array1 x = Array1::LinSpaced(kData, 0.05, 0.95);
  // Narrower than the finest ripple: one as long as the window would not be seen in its means.
  const double window = 0.01;
  NoisyValues data{x, x.square() + window * window / 12.0, Array1::Constant(kData, 1e-6),
                   Array1::Constant(kData, window)};
  const SmoothingSpline smooth(data, knots(), {Array1::Ones(kKnots - 2)}, 0.02);
  // Away from the ends, where the spline has no second derivative.
  const Array1 at = Array1::LinSpaced(33, 0.3, 0.7);
  const double off = window * window / 12.0;
  EXPECT_LT((smooth.value(at) - at.square()).abs().maxCoeff(), 0.01 * off);
}

}  // namespace
}  // namespace manoscope::numerics
