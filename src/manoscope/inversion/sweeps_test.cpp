#include "manoscope/inversion/sweeps.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "manoscope/core/random.hpp"
#include "tests/support/local_wall.hpp"

namespace manoscope::inversion {
namespace {

using calibration::Level;
using test::LocalWall;

constexpr double kLabelNoise = 10.0, kPixelNoise = 2e-9;  // Pa, m
const Stretch kStretch{1.6 * mm, 13.9 * mm};

/// Up and down again; on the way down the wall deflects as under a pressure higher by `lag`.
std::vector<Level> up_and_down(double lag, std::uint64_t seed) {
  const LocalWall wall;
  RandomStream random(seed, "sweeps");
  std::vector<double> pressures = test::log_spaced(14, 400.0, 20e3);
  const std::vector<double> down{15e3, 9e3, 5e3, 3e3, 1500.0, 800.0};
  const std::size_t n_up = pressures.size();
  pressures.insert(pressures.end(), down.begin(), down.end());
  std::vector<Level> levels;
  for (std::size_t k = 0; k < pressures.size(); ++k) {
    const double felt = pressures[k] + (k < n_up ? 0.0 : lag);
    Profile map =
        test::exact_profile(wall.stations(100), [&](double x) { return wall.zeta(x, felt); });
    map.uncertainty.independent.setConstant(kPixelNoise);
    for (double& zeta : map.zeta) zeta += kPixelNoise * random.normal();
    const bool vented = pressures[k] == 0.0;
    levels.push_back(test::level("h" + std::to_string(k),
                                 vented ? 0.0 : pressures[k] + kLabelNoise * random.normal(),
                                 vented ? 0.0 : kLabelNoise, map));
  }
  return levels;
}

TEST(Sweeps, OfAWallThatLagsDifferAsItDoesWithinTheirBars) {
  constexpr int kTrials = 60;
  for (const double lag : {0.0, 50.0}) {
    double squares = 0.0, largest = 0.0;
    for (int trial = 0; trial < kTrials; ++trial) {
      const auto found =
          compare_sweeps(up_and_down(lag, static_cast<std::uint64_t>(trial)), {}, kStretch);
      ASSERT_TRUE(found);
      EXPECT_EQ(found->n_up, 14);
      EXPECT_EQ(found->n_down, 6);
      squares += std::pow((found->difference + lag) / found->uncertainty, 2);
      largest = std::max(largest, found->uncertainty);
    }
    // 60 pulls: their root mean square scatters by 9 %; four times that.
    EXPECT_NEAR(std::sqrt(squares / kTrials), 1.0, 0.37) << lag;
    // Six labels of 10 Pa against curves through fourteen.
    EXPECT_LT(largest, 8.0);
  }
}

TEST(Sweeps, WantBothWays) {
  std::vector<Level> up = up_and_down(0.0, 1);
  up.resize(14);
  EXPECT_FALSE(compare_sweeps(up, {}, kStretch));
  std::vector<Level> two_down = up_and_down(0.0, 1);
  two_down.resize(16);
  EXPECT_FALSE(compare_sweeps(two_down, {}, kStretch));
  EXPECT_FALSE(compare_sweeps({}, {}, kStretch));
  const std::vector<Level> down(up.rbegin(), up.rend());
  EXPECT_FALSE(compare_sweeps(down, {}, kStretch));
}

}  // namespace
}  // namespace manoscope::inversion
