#include "manoscope/inversion/weak_window.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "manoscope/core/random.hpp"

namespace manoscope::inversion {
namespace {

constexpr double kPitch = 16e-6, kHalf = 200e-6, kCentre = 1.003e-3;

Array1 stations(Index n = 200) {
  return Array1::LinSpaced(n, 0.5 * kPitch, (static_cast<double>(n) - 0.5) * kPitch);
}

TEST(WeakWindow, SeesTheCurvatureOfAParabolaAndNoStraightLine) {
  const Array1 x = stations();
  const auto window = make_weak_window(x, Flags1::Ones(x.size()), kCentre, kHalf);
  ASSERT_TRUE(window.has_value());
  EXPECT_NEAR(window->mean.sum(), 1.0, 1e-14);
  // Round-off of 26 weights of 1e8/m2.
  EXPECT_NEAR(window->curvature_of(3.0 + 5e3 * x), 0.0, 1e-5);
  EXPECT_NEAR(window->curvature_of(3.5 * (x - 0.7e-3).square()), 7.0, 1e-9);
}

TEST(WeakWindow, MeansOfASineAndOfItsCurvatureAgree) {
  const Array1 x = stations();
  const auto window = make_weak_window(x, Flags1::Ones(x.size()), kCentre, kHalf);
  ASSERT_TRUE(window.has_value());
  for (const double wavelength : {2e-3, 1e-3, 0.6e-3}) {
    const double k = 2.0 * std::numbers::pi / wavelength;
    const Array1 wave = (k * (x - kCentre)).cos();
    // Exact to the fifth degree: what is left of a cosine is of sixth, (k half)^6/720, 0.012 at the
    // shortest, of which the moments of phi leave a twentieth.
    EXPECT_NEAR(window->curvature_of(wave) / (-k * k * window->mean_of(wave)), 1.0, 1e-3)
        << wavelength;
    // A stretch of standard deviation half_width/3: exp(-(k sigma)^2/2) but for the tails.
    EXPECT_NEAR(window->mean_of(wave), std::exp(-std::pow(k * kHalf / 3.0, 2) / 2.0), 0.02);
  }
}

TEST(WeakWindow, LeavesOutUnusableStationsAndStaysExact) {
  const Array1 x = stations();
  Flags1 usable = Flags1::Ones(x.size());
  usable[58] = usable[59] = usable[66] = 0;
  const auto window = make_weak_window(x, usable, kCentre, kHalf);
  ASSERT_TRUE(window.has_value());
  for (const Index hole : {58, 59, 66}) {
    EXPECT_EQ(window->mean[hole - window->first], 0.0);
    EXPECT_EQ(window->curvature[hole - window->first], 0.0);
  }
  EXPECT_NEAR(window->curvature_of(2.0 - 40.0 * x + 3.5 * x.square()), 7.0, 1e-5);
  // Means of the second derivative, 60 t^3 and 12 t^2, of fifth and fourth degree.
  const Array1 t = (x - kCentre) / kHalf;
  EXPECT_NEAR(window->curvature_of(3.0 * t.pow(5.0)) * kHalf * kHalf, 0.0, 1e-10);
  EXPECT_NEAR(window->curvature_of(t.pow(4.0)) * kHalf * kHalf, 12.0 / 9.0, 1e-10);
  // Mean of t times it: 6 t^2 of a third power.
  const Array1 cubic = t.segment(window->first, window->size()).pow(3.0);
  EXPECT_NEAR((window->skew * cubic).sum() * kHalf * kHalf, 6.0 / 9.0, 1e-10);
}

TEST(WeakWindow, IsNoneWhereItsStationsAreMissing) {
  const Array1 x = stations();
  const Flags1 all = Flags1::Ones(x.size());
  EXPECT_FALSE(make_weak_window(x, all, 0.1e-3, kHalf).has_value());   // reaches beyond the view
  EXPECT_FALSE(make_weak_window(x, all, kCentre, 50e-6).has_value());  // six stations
  Flags1 hole = all;
  hole.segment(60, 6).setZero();  // 112 um without a station, 0.56 half widths
  EXPECT_FALSE(make_weak_window(x, hole, kCentre, kHalf).has_value());
}

TEST(WeakWindow, RoughnessIsOneOfNoiseAndLargeOfABump) {
  const Array1 x = stations();
  const auto window = make_weak_window(x, Flags1::Ones(x.size()), kCentre, kHalf);
  ASSERT_TRUE(window.has_value());
  const Array1 smooth = 20e-6 * (1.0 - (-x.segment(window->first, window->size()) / 0.3e-3).exp());
  const Array1 sigma = Array1::Constant(window->size(), 2e-9);
  RandomStream random(3, "roughness");
  double sum = 0.0;
  constexpr int kDraws = 400;
  for (int draw = 0; draw < kDraws; ++draw) {
    Array1 noisy = smooth;
    for (double& value : noisy) value += 2e-9 * random.normal();
    sum += window->roughness(noisy, sigma);
  }
  // Variance 2/19 of a chi-square of 25 - 6 over its degrees of freedom: four standard errors, and
  // 0.01 for what a fifth degree leaves of the exponential, 0.06 nm.
  EXPECT_NEAR(sum / kDraws, 1.0, 4.0 * std::sqrt(2.0 / 19.0 / kDraws) + 0.01);
  Array1 bump = smooth;
  bump.segment(12, 4) += 20e-9;
  EXPECT_GT(window->roughness(bump, sigma), 5.0);
}

TEST(NotRough, DropsWhatStandsOutAndOnlyThat) {
  EXPECT_EQ(not_rough({1.0, 0.9, 1.2, 9.0, 1.1}),
            (std::vector<bool>{true, true, true, false, true}));
  EXPECT_EQ(not_rough({0.1, 0.1, 1.9, 0.1}), (std::vector<bool>{true, true, true, true}));
  EXPECT_EQ(not_rough({40.0, 50.0, 60.0}), (std::vector<bool>{true, true, true}));
  EXPECT_TRUE(not_rough({}).empty());
}

}  // namespace
}  // namespace manoscope::inversion
