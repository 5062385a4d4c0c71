#include "manoscope/inversion/station_stiffness.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "manoscope/calibration/fit_curves.hpp"
#include "manoscope/core/random.hpp"
#include "tests/support/local_wall.hpp"

namespace manoscope::inversion {
namespace {

using test::LocalWall;

calibration::ConstitutiveCurves curves(const LocalWall& wall, const std::vector<double>& pressures,
                                       double pixel, double label, RandomStream& random) {
  const Array1 x = wall.stations(20);
  std::vector<calibration::Level> levels;
  for (std::size_t k = 0; k < pressures.size(); ++k) {
    Profile profile =
        test::exact_profile(x, [&](double at) { return wall.zeta(at, pressures[k]); });
    for (double& zeta : profile.zeta) zeta += pixel * random.normal();
    profile.uncertainty.independent.setConstant(pixel);
    const double read = pressures[k] + (k == 0 ? 0.0 : label * random.normal());
    levels.push_back(
        test::level("h" + std::to_string(k), read, k == 0 ? 0.0 : label, std::move(profile)));
  }
  calibration::FitCurvesOptions options;
  options.joint_labels = false;
  return calibration::fit_curves(levels, options);
}

double exact(const LocalWall& wall, double x, double p) {
  const double zeta = wall.zeta(x, p);
  return (wall.stiffness + 3.0 * wall.stretching * zeta * zeta) / wall.taper(x);
}

TEST(StationStiffness, IsTheSlopeOfTheWallsOwnLaw) {
  const LocalWall wall;
  const auto pressures = test::log_spaced(20, 200.0, 20e3);
  RandomStream random(1, "unused");
  const auto found = station_stiffness(curves(wall, pressures, 0.0, 0.0, random));
  const Array1 x = wall.stations(20);
  for (Index k = 1; k + 1 < 20; ++k) {
    for (Index ix = 0; ix < 20; ++ix) {
      // The slope of a cubic interpolant at its knots: second order in steps of 0.1 of its scale.
      EXPECT_NEAR(found.value(k, ix) / exact(wall, x[ix], pressures[static_cast<std::size_t>(k)]),
                  1.0, 0.02);
    }
  }
}

TEST(StationStiffness, HasErrorsOfTheSizeThatItStates) {
  const LocalWall wall;
  const auto pressures = test::log_spaced(10, 200.0, 20e3);
  const double truth = exact(wall, wall.stations(20)[10], pressures[5]);
  constexpr int kDraws = 400;
  double squares = 0.0;
  for (int i = 0; i < kDraws; ++i) {
    RandomStream random(2, "stiffness", static_cast<std::uint64_t>(i));
    const auto found = station_stiffness(curves(wall, pressures, 5e-9, 10.0, random));
    squares += std::pow((found.value(5, 10) - truth) / found.uncertainty(5, 10), 2);
  }
  // Levels lie a factor of 1.8 apart: the difference of two slopes, which is no error of the better
  // one, is half of what is stated. Not wider than stated by more than four standard errors.
  const double width = std::sqrt(squares / kDraws);
  EXPECT_LT(width, 1.0 + 4.0 / std::sqrt(2.0 * kDraws));
  EXPECT_GT(width, 0.3);
}

TEST(StationStiffness, IsMissingWhereTheWallDoesNotRise) {
  std::vector<calibration::Level> levels;
  for (int k = 0; k < 4; ++k) {
    levels.push_back(
        test::level("h" + std::to_string(k), 1000.0 * k, 0.0,
                    test::exact_profile(Array1::LinSpaced(3, 1e-3, 3e-3),
                                        [&](double x) { return x < 2.5e-3 ? 1e-6 * k : 0.0; })));
  }
  levels[2].profile.flags[0] = 1;
  const auto found = station_stiffness(calibration::fit_curves(levels));
  EXPECT_NEAR(found.value(1, 1) / 1e9, 1.0, 1e-4);  // the scale of the curves bends a line by that
  EXPECT_TRUE(std::isnan(found.value(1, 2)));
  EXPECT_TRUE(std::isnan(found.value(1, 0)));  // its upper neighbour is missing there
  EXPECT_TRUE(std::isnan(found.uncertainty(1, 0)));
}

}  // namespace
}  // namespace manoscope::inversion
