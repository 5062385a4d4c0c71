#include "manoscope/inversion/free_curve.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "manoscope/calibration/fit_curves.hpp"
#include "tests/support/local_wall.hpp"

namespace manoscope::inversion {
namespace {

using End = FreeCurve::End;

/// p = 1e8 zeta + 1.2e18 zeta^3 far from the ends of a wall of ten widths.
calibration::ConstitutiveCurves curves(const test::LocalWall& wall, Index n_stations = 300) {
  const auto pressures = test::even(16, 0.0, 15e3);
  const Array1 x = Array1::LinSpaced(n_stations, 0.02e-3, wall.length - 0.02e-3);
  std::vector<calibration::Level> levels;
  for (std::size_t k = 0; k < pressures.size(); ++k) {
    levels.push_back(test::level(
        "h" + std::to_string(k), pressures[k], 0.0,
        test::exact_profile(x, [&](double at) { return wall.zeta(at, pressures[k]); })));
  }
  return calibration::fit_curves(levels);
}

TEST(FreeCurve, IsTheLawFarFromTheEnds) {
  test::LocalWall wall;
  wall.decay = 0.25e-3;
  const auto set = curves(wall);
  for (const End end : {End::inlet, End::outlet}) {
    const auto curve = FreeCurve::about(set, Length::from_si(wall.length), 1.5 * mm, end);
    ASSERT_TRUE(curve.has_value());
    for (const double zeta : {2e-6, 7e-6, 12e-6, 18e-6}) {
      const FreeCurve::Point at = curve->at_deflection(zeta);
      // Two widths are twelve decay lengths; the rest is interpolation between levels 1 kPa apart,
      // most in the first interval.
      EXPECT_NEAR(at.pressure, 1e8 * zeta + 1.2e18 * std::pow(zeta, 3), 5.0) << zeta;
      EXPECT_NEAR(at.stiffness / (1e8 + 3.6e18 * zeta * zeta), 1.0, 0.05) << zeta;
      // Straight lines between eight points an interval.
      EXPECT_NEAR(curve->deflection(at.pressure) / zeta, 1.0, 0.01) << zeta;
      const auto [below, share] = curve->place(zeta);
      EXPECT_LE(curve->knots()[below].zeta, zeta);
      EXPECT_GT(curve->knots()[below + 1].zeta, zeta);
      EXPECT_GT(share, 0.0);
      EXPECT_LT(share, 1.0);
    }
    for (const Index ix : curve->stations()) {
      const double distance = end == End::inlet ? set.x[ix] : wall.length - set.x[ix];
      EXPECT_GE(distance, 3.0e-3);
      EXPECT_LE(distance, 4.5e-3);
    }
  }
}

TEST(FreeCurve, GoesStraightOnByATenthOfAnIntervalAndNoFarther) {
  const test::LocalWall wall;
  const auto curve =
      FreeCurve::about(curves(wall), Length::from_si(wall.length), 1.5 * mm, End::inlet);
  ASSERT_TRUE(curve.has_value());
  const double step = curve->knots()[1].zeta - curve->knots()[0].zeta;
  // By the slope of the first level, 1e8 Pa/m; the interpolant knows it to 10 %.
  EXPECT_NEAR(curve->at_deflection(-0.05 * step).pressure, -5e6 * step, 5e5 * step);
  EXPECT_TRUE(std::isnan(curve->at_deflection(-0.2 * step).pressure));
  EXPECT_TRUE(std::isnan(curve->at_deflection(1e-3).pressure));
}

TEST(FreeCurve, IsNoneOfAShortChannelOrAWallThatFalls) {
  const test::LocalWall wall;
  const auto set = curves(wall);
  EXPECT_FALSE(FreeCurve::about(set, 15.5 * mm, 4.0 * mm, End::inlet).has_value());
  std::vector<calibration::Level> levels;
  for (int k = 0; k < 5; ++k) {
    const double zeta = k == 3 ? 0.5e-6 : 1e-6 * k;  // falls from the third level to the fourth
    levels.push_back(test::level("h" + std::to_string(k), 1000.0 * k, 0.0,
                                 test::exact_profile(set.x, [&](double) { return zeta; })));
  }
  EXPECT_FALSE(FreeCurve::about(calibration::fit_curves(levels), 15.5 * mm, 1.5 * mm, End::inlet)
                   .has_value());
}

}  // namespace
}  // namespace manoscope::inversion
