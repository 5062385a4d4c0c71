#include "manoscope/calibration/pressure_scale.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "manoscope/core/error.hpp"
#include "tests/support/local_wall.hpp"

namespace manoscope::calibration {
namespace {

using test::even;
using test::log_spaced;
using test::one_station;

template <class F>
std::vector<Level> wall(const std::vector<double>& pressures, F&& zeta_of) {
  std::vector<double> zetas;
  for (const double p : pressures) zetas.push_back(zeta_of(p));
  return one_station(pressures, zetas);
}

TEST(PressureScale, CoordinateSolvesTheMembraneLawForAnySignAndSize) {
  for (const double unit : {1e-2, 30.0, 5e3, 1e9}) {
    const PressureScale scale(unit);
    EXPECT_EQ(scale.coordinate(0.0), 0.0);
    for (double size = 1e-6; size < 1e8; size *= 7.3) {
      for (const double p : {size, -size}) {
        const double u = scale.coordinate(p);
        EXPECT_NEAR(unit * (u + u * u * u), p, 1e-13 * size) << unit;  // a few hundred round-offs
        EXPECT_NEAR(scale.pressure(u), p, 1e-13 * size) << unit;
      }
    }
  }
}

TEST(PressureScale, DerivativeAgreesWithDifferences) {
  const PressureScale scale(400.0);
  for (const double p : {-9e3, -300.0, 0.0, 50.0, 400.0, 7e4}) {
    const double step = 1e-4 * (std::abs(p) + 400.0);
    const double difference =
        (scale.coordinate(p + step) - scale.coordinate(p - step)) / (2.0 * step);
    // Relative error of the difference: third derivative times step squared.
    EXPECT_NEAR(scale.derivative(p) / difference, 1.0, 1e-7) << p;
  }
}

TEST(PressureScale, RefusesAUnitThatIsNotPositive) {
  EXPECT_THROW(PressureScale(0.0), InternalError);
  EXPECT_THROW(PressureScale(-1.0), InternalError);
}

TEST(FitPressureScale, FindsTheUnitOfAMembraneFromLogSpacedAndEvenLevels) {
  const test::LocalWall membrane;
  const double x = 0.5 * membrane.length;
  const double unit = std::pow(membrane.stiffness, 1.5) / std::sqrt(membrane.stretching);
  for (const auto& pressures : {log_spaced(24, 100.0, 50e3), even(21, 0.0, 50e3)}) {
    const auto levels = wall(pressures, [&](double p) { return membrane.zeta(x, p); });
    const double found = fit_pressure_scale(levels).unit();
    EXPECT_LT(std::abs(std::log(found / unit)), std::log(1.2));  // the grid's ratio step
  }
}

TEST(FitPressureScale, IsLinearOverTheRangeForALinearWall) {
  for (const auto& pressures : {log_spaced(24, 100.0, 50e3), even(21, -2e3, 50e3)}) {
    const auto scale = fit_pressure_scale(wall(pressures, [](double p) { return 1e-9 * p; }));
    // Slope at the top over slope at zero: 1 / (1 + 3 u^2) with u <= 1/100.
    EXPECT_NEAR(scale.derivative(50e3) / scale.derivative(0.0), 1.0, 3e-4);
  }
}

TEST(FitPressureScale, IgnoresStationsWithoutData) {
  const test::LocalWall membrane;
  const double x = 0.5 * membrane.length;
  auto levels = wall(log_spaced(12, 100.0, 50e3), [&](double p) { return membrane.zeta(x, p); });
  const double unit = fit_pressure_scale(levels).unit();
  for (std::size_t k = 0; k < levels.size(); ++k) {  // a second station, good in two levels only
    Profile& profile = levels[k].profile;
    profile.x = Array1::LinSpaced(2, 7e-3, 8e-3);
    profile.zeta.conservativeResize(2);
    profile.flags.conservativeResize(2);
    profile.zeta[1] = k < 2 ? -5e-6 : 1e-3;  // what stands under a flag means nothing
    profile.flags[1] = k < 2 ? 0 : StationFlag::no_data;
  }
  EXPECT_EQ(fit_pressure_scale(levels).unit(), unit);
  for (auto& each : levels) each.profile.flags.setConstant(StationFlag::no_data);
  EXPECT_GT(fit_pressure_scale(levels).unit(), 0.0);  // nothing to go by, but no failure
}

}  // namespace
}  // namespace manoscope::calibration
