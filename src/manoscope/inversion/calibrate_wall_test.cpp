#include "manoscope/inversion/calibrate_wall.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "manoscope/inversion/test_calibrated_wall.hpp"

namespace manoscope::inversion {
namespace {

using test_support::channel;

TEST(CalibrateWall, FindsTheWallThatMadeTheCalibration) {
  std::string reason;
  const auto found = calibrate_wall(channel().curves(1e-10, 0.0, 1), channel().known(), reason);
  ASSERT_TRUE(found) << reason;
  const wall::ClampedWall& wall = found->wall;
  // Eight widths long: the strip's law holds at mid-channel but for e^(-4 pi), and the average
  // over 36 cells; the sheared part of a thick wall near its ends adds some tenths of a percent.
  EXPECT_NEAR(wall.youngs_modulus.si() / 1.5e6, 1.0, 0.01);
  EXPECT_NEAR(wall.prestress.si(), 20e3, 2e3);
  EXPECT_NEAR(wall.preload.load.si(), 0.0, 2.0);
  EXPECT_EQ(wall.preload.lopsidedness, 0.0);
  EXPECT_EQ(wall.shear_correction, 5.0 / 6.0);
}

TEST(CalibrateWall, SaysWhyThereIsNone) {
  // Levels that all show the same deflection.
  std::vector<calibration::Level> levels;
  for (std::size_t k = 0; k < 6; ++k) {
    levels.push_back(test::level("h" + std::to_string(k), 100.0 * static_cast<double>(k), 1.0,
                                 test::exact_profile(channel().x, [](double) { return 1e-6; })));
  }
  std::string reason;
  const auto curves = calibration::fit_curves(levels);
  EXPECT_FALSE(calibrate_wall(curves, channel().known(), reason));
  EXPECT_NE(reason, "");
}

TEST(EndMisfit, IsSmallForTheWallItselfAndTellsAWallOfAnotherReach) {
  const auto curves = channel().curves(1e-10, 0.0, 1);
  const Index n = static_cast<Index>(curves.levels.size());
  Array2 same(n, curves.x.size()), other(n, curves.x.size());
  for (Index k = 0; k < n; ++k) {
    same.row(k) = curves.levels[static_cast<std::size_t>(k)].profile.zeta;
    // An end layer a fifth longer: the profile as it stands at 1/1.2 of the distance.
    for (Index i = 0; i < curves.x.size(); ++i) {
      const double x = curves.x[i], near = x < 4e-3 ? x / 1.2 : 8e-3 - (8e-3 - x) / 1.2;
      const Index at =
          std::clamp<Index>(static_cast<Index>((near - 0.01e-3) / (7.98e-3 / 399.0)), 0, 399);
      other(k, i) = curves.levels[static_cast<std::size_t>(k)].profile.zeta[at];
    }
  }
  EXPECT_LT(end_misfit(curves, same, 8.0 * mm, 1.0 * mm), 1e-12);
  EXPECT_GT(end_misfit(curves, other, 8.0 * mm, 1.0 * mm), 0.03);
}

}  // namespace
}  // namespace manoscope::inversion
