#include "manoscope/validation/wall_answer.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "manoscope/calibration/fit_curves.hpp"
#include "manoscope/core/flags.hpp"
#include "tests/support/local_wall.hpp"

namespace manoscope::validation {
namespace {

constexpr double kShare = 0.1;

/// 1 um of nitride: it gives way by 20 um/kPa at first, and has risen by 44 um at 100 kPa.
const test::LocalWall kStiffening{.stiffness = 5e7};

std::vector<calibration::Level> levels(const Array1& x) {
  std::vector<calibration::Level> result;
  for (const double p : test::log_spaced(20, 300.0, 1e5)) {
    result.push_back(
        test::level("h" + std::to_string(result.size()), p, p == 0.0 ? 0.0 : 1.0,
                    test::exact_profile(x, [&](double at) { return kStiffening.zeta(at, p); })));
  }
  return result;
}

TEST(CurvedWall, GoesOnStraightByAShareOfWhatTheCalibrationSpans) {
  const Array1 x = kStiffening.stations(21);
  const CurvedWall wall(calibration::fit_curves(levels(x)), 15.5 * mm, kShare);
  const double highest = kStiffening.zeta(7.75e-3, 1e5);
  // A tenth of the pressures below 0, 10 kPa, would be -200 um by the slope there: a closed
  // channel.
  EXPECT_LT(wall.least(), 0.0);
  EXPECT_GE(wall.least(), -1.001 * kShare * highest);
  EXPECT_LE(wall.greatest(), (1.0 + kShare) * highest);
  // Above, where the wall is stiff, it is a tenth of the pressures.
  const Index middle = wall.size() / 2;
  EXPECT_EQ(wall.beyond(middle, 1.09e5), 0.0);
  EXPECT_GT(wall.beyond(middle, 1.11e5), 0.0);
  EXPECT_GT(wall.beyond(middle, -1e3), 0.0);
}

TEST(CurvedWall, DoesNotMindWhereTheWallHardlyMoves) {
  // 30 um from the clamped end the lowest levels cannot be told apart: the curve begins at 1 kPa.
  Array1 x = kStiffening.stations(21);
  x[20] = 15.47e-3;
  std::vector<calibration::Level> some = levels(x);
  for (auto& level : some) {
    if (level.pressure < 1000.0 * Pa) level.profile.flags[20] = StationFlag::no_data;
  }
  const CurvedWall wall(calibration::fit_curves(some), 15.5 * mm, kShare);
  ASSERT_EQ(wall.size(), 23);
  EXPECT_EQ(wall.beyond(21, 100.0), 0.0);
}

TEST(CurvedWall, LeavesOutAStationWhoseCurveEndsFarFromWhereTheOthersDo) {
  const Array1 x = kStiffening.stations(21);
  std::vector<calibration::Level> some = levels(x);
  for (std::size_t k = some.size() / 2; k < some.size(); ++k) {
    some[k].profile.flags[20] = StationFlag::no_data;
  }
  const CurvedWall wall(calibration::fit_curves(some), 15.5 * mm, kShare);
  // Twenty stations and the clamped ends; between them zeta is straight.
  EXPECT_EQ(wall.size(), 22);
  for (Index i = 0; i < wall.size(); ++i) EXPECT_EQ(wall.beyond(i, 9.9e4), 0.0) << i;
}

}  // namespace
}  // namespace manoscope::validation
