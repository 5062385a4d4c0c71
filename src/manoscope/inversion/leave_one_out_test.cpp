#include "manoscope/inversion/leave_one_out.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "manoscope/core/random.hpp"
#include "tests/support/local_wall.hpp"

namespace manoscope::inversion {
namespace {

using calibration::FitCurvesOptions;
using calibration::Level;
using test::LocalWall;

constexpr double kPixelNoise = 2e-9, kPlaneNoise = 1.5e-9;  // m
constexpr double kLabelNoise = 10.0;                        // Pa
const Stretch kStretch{1.6 * mm, 13.9 * mm};

/// 20 levels of a wall known exactly, seen with noise; labels with theirs, but for the vented one.
std::vector<Level> seen(RandomStream& random) {
  const LocalWall wall;
  std::vector<Level> levels;
  for (const double pressure : test::log_spaced(20, 200.0, 20e3)) {
    const std::string name = "h" + std::to_string(levels.size());
    Profile map =
        test::exact_profile(wall.stations(200), [&](double x) { return wall.zeta(x, pressure); });
    const Index n = map.x.size();
    map.uncertainty.independent.setConstant(kPixelNoise);
    for (double& zeta : map.zeta) zeta += kPixelNoise * random.normal();
    const Array1 plane = Array1::Constant(n, kPlaneNoise);
    map.zeta += plane * random.normal();
    map.uncertainty.modes.push_back({"level plane of " + name, "leveling", plane});
    const bool vented = pressure == 0.0;
    levels.push_back(test::level(name, vented ? 0.0 : pressure + kLabelNoise * random.normal(),
                                 vented ? 0.0 : kLabelNoise, map));
  }
  return levels;
}

struct Sums {
  double n = 0.0, mean = 0.0, squares = 0.0, error_squares = 0.0;
};

/// Of all inner levels of many experiments.
Sums pulls(const FitCurvesOptions& options, int n_experiments) {
  RandomStream random(17, "leave one out");
  Sums sums;
  for (int trial = 0; trial < n_experiments; ++trial) {
    const auto left_out =
        leave_one_out(calibration::fit_curves(seen(random), options), options, kStretch);
    for (const LevelLeftOut& level : left_out.levels) {
      if (std::isnan(level.mean_error)) continue;
      const double pull = level.mean_error / level.mean_uncertainty;
      sums.n += 1.0;
      sums.mean += pull;
      sums.squares += pull * pull;
      sums.error_squares += level.mean_error * level.mean_error;
    }
  }
  return sums;
}

TEST(LeaveOneOut, PullsAreTrueWhereLabelsAreTakenAsRead) {
  FitCurvesOptions options;
  options.joint_labels = false;
  const Sums sums = pulls(options, 25);
  ASSERT_EQ(sums.n, 25 * 18);
  // 450 pulls, and neighbours hang together: 4 sigma of half as many.
  EXPECT_NEAR(sums.mean / sums.n, 0.0, 0.2);
  EXPECT_NEAR(std::sqrt(sums.squares / sums.n), 1.0, 0.19);
  // The level's own label and, half of each, those of two neighbours at the least.
  EXPECT_GT(std::sqrt(sums.error_squares / sums.n), 12.0);
}

TEST(LeaveOneOut, PullsAreTrueWhereLabelsAreEstimatedTogether) {
  const Sums sums = pulls({}, 25);
  EXPECT_NEAR(sums.mean / sums.n, 0.0, 0.2);
  EXPECT_NEAR(std::sqrt(sums.squares / sums.n), 1.0, 0.19);
  // What is left is the level's own label and little else.
  EXPECT_LT(std::sqrt(sums.error_squares / sums.n), 11.5);
}

TEST(LeaveOneOut, TellsALevelWhoseLabelIsWrong) {
  RandomStream random(18, "wrong label");
  std::vector<Level> levels = seen(random);
  levels[11].pressure += 150.0 * Pa;
  const auto left_out = leave_one_out(calibration::fit_curves(levels), {}, kStretch);
  const LevelLeftOut& wrong = left_out.levels[11];
  EXPECT_NEAR(wrong.mean_error, -150.0, 40.0);
  EXPECT_LT(wrong.mean_error / wrong.mean_uncertainty, -8.0);
}

TEST(LeaveOneOut, HasOneNumberAStationInTheStretchAndNoneForTheOutermost) {
  RandomStream random(19, "numbers");
  const auto left_out = leave_one_out(calibration::fit_curves(seen(random)), {}, kStretch);
  ASSERT_EQ(left_out.levels.size(), 20u);
  EXPECT_EQ(left_out.x.size(), 30);
  EXPECT_GE(left_out.x[0], 1.6e-3);
  EXPECT_LE(left_out.x[29], 13.9e-3);
  for (const std::size_t k : {0, 19}) {
    EXPECT_TRUE(std::isnan(left_out.levels[k].mean_error));
    EXPECT_TRUE(left_out.levels[k].error.isNaN().all());
  }
  const LevelLeftOut& level = left_out.levels[9];
  EXPECT_TRUE(level.error.isFinite().all());
  EXPECT_NEAR(level.error.mean(), level.mean_error, 1e-9);  // round-off
  // The mean has less noise than a station, never less than the label.
  EXPECT_LT(level.mean_uncertainty, level.uncertainty.mean());
  EXPECT_GE(level.mean_uncertainty, kLabelNoise);
}

TEST(LeaveOneOut, NeedsFourLevels) {
  RandomStream random(20, "few");
  std::vector<Level> levels = seen(random);
  levels.resize(3);
  EXPECT_TRUE(leave_one_out(calibration::fit_curves(levels), {}, kStretch).levels.empty());
}

}  // namespace
}  // namespace manoscope::inversion
