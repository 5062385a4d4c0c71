#include "manoscope/inversion/intersections.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "manoscope/core/error.hpp"
#include "manoscope/core/random.hpp"
#include "tests/support/local_wall.hpp"
#include "tests/support/quiet_traps.hpp"

namespace manoscope::inversion {
namespace {

using calibration::Level;
using test::exact_profile;
using test::level;

constexpr Length kWidth = 1.7 * mm;
const Array1 kX = Array1::LinSpaced(1001, 0.0, 15e-3);

std::vector<Level> flat_levels(const std::vector<double>& zetas) {
  std::vector<Level> levels;
  for (std::size_t k = 0; k < zetas.size(); ++k) {
    levels.push_back(level("h" + std::to_string(k), 1e3 * static_cast<double>(k), 10.0,
                           exact_profile(kX, [&](double) { return zetas[k]; })));
  }
  return levels;
}

Profile noisy(Profile profile, double sigma, RandomStream& stream) {
  for (double& zeta : profile.zeta) zeta += sigma * stream.normal();
  profile.uncertainty.independent.setConstant(sigma);
  return profile;
}

/// Falls from 10 um at the inlet to 0 at the outlet, slightly bent.
double falling(double x) {
  const double s = x / 15e-3;
  return 10e-6 * (1.0 - s) * (1.0 - 0.2 * s);
}

TEST(Intersections, FindTheExactCrossingOfEachLevel) {
  const std::vector<double> zetas{1e-6, 3e-6, 5e-6, 8e-6};
  const auto found = find_intersections(flat_levels(zetas), exact_profile(kX, falling), kWidth);
  ASSERT_EQ(found.size(), zetas.size());
  for (std::size_t k = 0; k < zetas.size(); ++k) {
    // (1 - s)(1 - 0.2 s) = c  ->  0.2 s^2 - 1.2 s + 1 - c = 0
    const double c = zetas[k] / 10e-6;
    const double s = (1.2 - std::sqrt(1.44 - 0.8 * (1.0 - c))) / 0.4;
    // A line fitted over the window is off by curvature window^2 / 24; a fifth more, because the
    // window ends at a station.
    const double slope = 10e-6 * (1.2 - 0.4 * s) / 15e-3, curvature = 10e-6 * 0.4 / (15e-3 * 15e-3);
    const double window = 0.1 * kWidth.si();
    EXPECT_NEAR(found[k].x.si(), s * 15e-3, 1.2 * curvature * window * window / 24.0 / slope);
    EXPECT_EQ(found[k].pressure.si(), 1e3 * static_cast<double>(k));
    EXPECT_EQ(found[k].pressure_uncertainty.si(), 10.0);
    EXPECT_EQ(found[k].x_uncertainty.si(), 0.0);
  }
}

TEST(Intersections, FindBothCrossingsOfABulgeInOrder) {
  const auto bulge = exact_profile(kX, [](double x) {
    const double s = (x - 7.5e-3) / 5e-3;
    return 4e-6 * (1.0 - s * s);
  });
  const auto found = find_intersections(flat_levels({-9e-6, 0.0, 3e-6}), bulge, kWidth);
  ASSERT_EQ(found.size(), 4U);
  EXPECT_NEAR(found[0].x.si(), 2.5e-3, 2e-6);
  EXPECT_NEAR(found[1].x.si(), 12.5e-3, 2e-6);
  EXPECT_NEAR(found[2].x.si(), 5.0e-3, 2e-6);
  EXPECT_NEAR(found[3].x.si(), 10.0e-3, 2e-6);
}

TEST(Intersections, AreNoneWhereProfilesDoNotCross) {
  const auto levels = flat_levels({11e-6, 12e-6});
  EXPECT_TRUE(find_intersections(levels, exact_profile(kX, falling), kWidth).empty());
  EXPECT_TRUE(find_intersections(levels, levels[0].profile, kWidth).empty());  // the level itself
}

TEST(Intersections, AreNoneWhereProfilesOnlyTouch) {
  const auto touching = exact_profile(kX, [](double x) {
    const double s = (x - 7.5e-3) / 5e-3;
    return 2e-6 - 4e-6 * s * s;
  });
  EXPECT_TRUE(find_intersections(flat_levels({2e-6}), touching, kWidth).empty());
  RandomStream stream(1, "touch");
  int crossings = 0;
  for (int trial = 0; trial < 200; ++trial) {
    const auto state = noisy(touching, 20e-9, stream);
    crossings += static_cast<int>(find_intersections(flat_levels({2e-6}), state, kWidth).size());
  }
  // Near the top noise makes many changes of sign; few of their clusters look like a crossing.
  EXPECT_LE(crossings, 20) << "of 200";
}

TEST(Intersections, OfIdenticalNoisyProfilesAreSeldom) {
  // Slope tested at 3 standard errors: 0.3 % of the clusters, and a profile has 1 to 90 of them.
  RandomStream stream(2, "same");
  std::size_t crossings = 0, trials = 100;
  for (std::size_t trial = 0; trial < trials; ++trial) {
    auto levels = flat_levels({2e-6});
    levels[0].profile = noisy(levels[0].profile, 5e-9, stream);
    crossings +=
        find_intersections(levels, noisy(flat_levels({2e-6})[0].profile, 5e-9, stream), kWidth)
            .size();
  }
  EXPECT_LT(crossings, trials / 2);
}

TEST(Intersections, ManyChangesOfSignMakeOneCrossingWithItsUncertainty) {
  // Slope 0.8 nm per micrometre at mid-channel; 20 nm of noise changes sign for dozens of pixels.
  const double zeta = falling(7.5e-3);
  RandomStream stream(3, "pulls");
  constexpr int kTrials = 1000;
  int alone = 0;
  double sum = 0.0, squares = 0.0;
  for (int trial = 0; trial < kTrials; ++trial) {
    auto levels = flat_levels({zeta});
    levels[0].profile = noisy(levels[0].profile, 10e-9, stream);
    const auto found =
        find_intersections(levels, noisy(exact_profile(kX, falling), 15e-9, stream), kWidth);
    alone += found.size() == 1;
    if (found.size() != 1) continue;
    const double pull = (found[0].x.si() - 7.5e-3) / found[0].x_uncertainty.si();
    sum += pull;
    squares += pull * pull;
  }
  EXPECT_GE(alone, 0.98 * kTrials);
  // Four standard errors; a nonlinear zero and the choice of the window's centre by the same noise
  // add up to 5 % to the width.
  EXPECT_NEAR(sum / alone, 0.0, 4.0 / std::sqrt(kTrials));
  EXPECT_NEAR(std::sqrt(squares / alone), 1.0, 4.0 / std::sqrt(2.0 * kTrials) + 0.05);
}

TEST(Intersections, DoNotCountStationsWithoutData) {
  auto state = exact_profile(kX, falling);
  for (Index ix = 0; ix < kX.size(); ++ix) {
    if (std::abs(kX[ix] - 7.5e-3) < 0.02e-3) {
      state.flags[ix] = StationFlag::no_data;
      state.zeta[ix] = 0.0;
    }
  }
  const auto found = find_intersections(flat_levels({falling(7.5e-3)}), state, kWidth);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_NEAR(found[0].x.si(), 7.5e-3, 1e-6);
  state.flags.setConstant(StationFlag::no_data);
  EXPECT_TRUE(find_intersections(flat_levels({5e-6}), state, kWidth).empty());
}

TEST(Intersections, RefuseAWindowThatIsNone) {
  IntersectionOptions options;
  EXPECT_NO_THROW(options.validate());  // auto
  const test::QuietTraps quiet;         // a NaN is handed in and told
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double window : {0.0, -1e-4, nan}) {
    options.window = Length::from_si(window);
    EXPECT_THROW(
        find_intersections(flat_levels({5e-6}), exact_profile(kX, falling), kWidth, options),
        InputError);
    try {
      options.validate();
      ADD_FAILURE() << window;
    } catch (const InputError& error) {
      EXPECT_EQ(error.where(), "--crossing-window");
    }
  }
}

TEST(Intersections, NeedThreeStationsInTheWindow) {
  IntersectionOptions options;
  options.window = 1.0 * um;  // below the pitch of 15 um
  EXPECT_TRUE(
      find_intersections(flat_levels({5e-6}), exact_profile(kX, falling), kWidth, options).empty());
}

}  // namespace
}  // namespace manoscope::inversion
