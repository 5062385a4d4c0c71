#include "manoscope/calibration/snap.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <utility>

#include "manoscope/core/random.hpp"

namespace manoscope::calibration {
namespace {

/// Levels of a wall whose stations follow one curve, labels off by 3 Pa.
std::vector<Level> levels_of(const std::vector<double>& pressures,
                             const std::function<double(double)>& deflection,
                             std::uint64_t seed = 1) {
  RandomStream noise(seed, "snap");
  std::vector<Level> levels;
  for (const double pressure : pressures) {
    Level level;
    level.pressure = Pressure::from_si(pressure + (pressure > 0.0 ? 3.0 * noise.normal() : 0.0));
    level.uncertainty = 3.0 * Pa;
    level.profile.x = Array1::LinSpaced(6, 0.0, 5e-3);
    level.profile.zeta = deflection(pressure) * Array1::LinSpaced(6, 0.5, 1.0);
    level.profile.uncertainty.independent = Array1::Constant(6, 2e-9);
    level.profile.flags = Flags1::Zero(6);
    levels.push_back(std::move(level));
  }
  return sort_levels(std::move(levels));
}

const std::vector<double> kPressures{0,   40,  80,   120,  160,  200,  250,  300,
                                     400, 600, 1000, 2000, 4000, 8000, 20e3, 50e3};

/// The s at which p = a s + 0.45e18 s^3, m.
double rise(double p, double a) {
  double low = -60e-6, high = 60e-6;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (a * middle + 0.45e18 * std::pow(middle, 3) < p ? low : high) = middle;
  }
  return low;
}
/// A membrane under tension, and one that stands bowed in by 8 um below 140 Pa.
double membrane(double p) { return rise(p, 1e8); }
double snapping(double p) { return p < 140.0 ? -8e-6 + 2e-9 * p : membrane(p); }

TEST(LevelAfterSnap, IsTheFirstBeyondTheJump) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const auto found = level_after_snap(levels_of(kPressures, snapping, seed));
    ASSERT_TRUE(found);
    EXPECT_EQ(*found, 4) << seed;
  }
}

TEST(LevelAfterSnap, IsNoneOfAWallThatOnlyStiffens) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    EXPECT_FALSE(level_after_snap(levels_of(kPressures, membrane, seed))) << seed;
    // Passing the plane under 700 Pa of preload, almost slack.
    const auto passing = [](double p) { return rise(p - 700.0, 2e7); };
    EXPECT_FALSE(level_after_snap(levels_of(kPressures, passing, seed))) << seed;
  }
  // Repeats: no rise at all between them, and the wall's own from one pair to the next.
  const auto plate = [](double p) { return 1e-9 * p; };
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    EXPECT_FALSE(level_after_snap(
        levels_of({0, 700, 700, 1400, 1400, 2100, 2100, 2800, 2800, 3500, 3500}, plate, seed)))
        << seed;
  }
  EXPECT_FALSE(level_after_snap(levels_of({0, 100, 200}, snapping)));
}

}  // namespace
}  // namespace manoscope::calibration
