#include "manoscope/inversion/read_pressure.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "manoscope/calibration/fit_curves.hpp"
#include "manoscope/core/error.hpp"
#include "manoscope/core/flags.hpp"
#include "manoscope/core/random.hpp"
#include "tests/support/local_wall.hpp"
#include "tests/support/quiet_traps.hpp"

namespace manoscope::inversion {
namespace {

using calibration::fit_curves;
using calibration::Level;
using test::even;
using test::exact_profile;
using test::level;
using test::LocalWall;
using test::log_spaced;
using test::one_station;

std::vector<Level> calibrate(const LocalWall& wall, const Array1& x,
                             const std::vector<double>& pressures) {
  std::vector<Level> levels;
  for (const double p : pressures) {
    levels.push_back(level("h" + std::to_string(levels.size()), p, 0.0,
                           exact_profile(x, [&](double at) { return wall.zeta(at, p); })));
  }
  return levels;
}

/// A map of one station.
Profile state_of(double zeta, double sigma = 0.0) {
  Profile profile = exact_profile(Array1::Constant(1, 7e-3), [&](double) { return zeta; });
  profile.uncertainty.independent.setConstant(sigma);
  return profile;
}

TEST(ReadPressure, GivesEachLevelsOwnPressureBack) {
  const LocalWall wall;
  const auto levels = calibrate(wall, wall.stations(31), log_spaced(18, 100.0, 50e3));
  const auto curves = fit_curves(levels);
  for (const Level& each : levels) {
    const auto reading = read_pressure(curves, each.profile);
    for (Index ix = 0; ix < reading.x.size(); ++ix) {
      ASSERT_TRUE(reading.answered(ix)) << each.name << " at " << ix;
      EXPECT_NEAR(reading.pressure[ix], each.pressure.si(), 1e-10 * 50e3);  // round-off
    }
  }
}

TEST(ReadPressure, ReadsAnyPressureOfAnExactWallBetweenItsLevels) {
  const LocalWall wall;
  const Array1 x = wall.stations(40);
  const auto curves = fit_curves(calibrate(wall, x, log_spaced(25, 100.0, 50e3)));
  RandomStream stream(3, "pressures");
  for (int trial = 0; trial < 200; ++trial) {
    const double inlet = stream.uniform(1e3, 49e3), outlet = stream.uniform(0.0, 1e3);
    const auto truth = [&](double at) { return inlet + (outlet - inlet) * at / wall.length; };
    const auto state = exact_profile(x, [&](double at) { return wall.zeta(at, truth(at)); });
    const auto reading = read_pressure(curves, state);
    for (Index ix = 0; ix < x.size(); ++ix) {
      ASSERT_TRUE(reading.answered(ix));
      // Interpolation between 25 levels.
      EXPECT_NEAR(reading.pressure[ix], truth(x[ix]), 2e-4 * truth(x[ix]) + 0.5);
      EXPECT_NEAR(
          reading.slope[ix],
          (wall.zeta(x[ix], truth(x[ix]) + 0.1) - wall.zeta(x[ix], truth(x[ix]) - 0.1)) / 0.2,
          0.05 * reading.slope[ix]);
    }
  }
}

TEST(ReadPressure, RisesWithDeflection) {
  RandomStream stream(4, "walls");
  for (int trial = 0; trial < 50; ++trial) {
    std::vector<double> pressures{0.0}, zetas{-2e-6};
    for (int k = 0; k < 12; ++k) {
      pressures.push_back(pressures.back() + stream.uniform(50.0, 5e3));
      zetas.push_back(zetas.back() + std::pow(stream.uniform(), 3) * 1e-6 + 1e-10);
    }
    const auto curves = fit_curves(one_station(pressures, zetas));
    double last = -1.0;
    int answers = 0;
    for (int i = 0; i <= 300; ++i) {
      const double zeta = zetas.front() + (zetas.back() - zetas.front()) * (i / 300.0);
      const auto reading = read_pressure(curves, state_of(std::min(zeta, zetas.back())));
      if (!reading.answered(0)) continue;  // a slope of exactly 0 is possible at a knot
      EXPECT_GE(reading.pressure[0], last);
      last = reading.pressure[0];
      ++answers;
    }
    EXPECT_GE(answers, 290);
  }
}

TEST(ReadPressure, SaysOutOfCalibrationOnBothSidesAndExtrapolatesNowhere) {
  const auto curves = fit_curves(one_station(even(6, 1e3, 11e3), even(6, 1e-6, 11e-6)));
  for (const double zeta : {0.999e-6, 11.001e-6, -5e-6, 1e-3}) {
    const auto reading = read_pressure(curves, state_of(zeta));
    EXPECT_EQ(reading.flags[0], ReadingFlag::out_of_calibration);
    EXPECT_FALSE(reading.answered(0));
    EXPECT_EQ(reading.pressure[0], 0.0);
    EXPECT_EQ(reading.upper[0] - reading.lower[0], 0.0);
  }
  EXPECT_EQ(read_pressure(curves, state_of(1.001e-6)).flags[0], 0);
  EXPECT_EQ(read_pressure(curves, state_of(10.999e-6)).flags[0], 0);
}

/// Deflection rises to 3 um at 3 kPa, falls to 2 um at 5 kPa, and rises for good.
calibration::ConstitutiveCurves folded() {
  return fit_curves(one_station({0.0, 1e3, 2e3, 3e3, 4e3, 5e3, 6e3, 7e3, 8e3},
                                {0.0, 1e-6, 2.2e-6, 3e-6, 2.5e-6, 2e-6, 2.8e-6, 4e-6, 5e-6},
                                10e-9));
}

TEST(ReadPressure, SaysAmbiguousWhereTwoPressuresFitAndNowhereElse) {
  const auto curves = folded();
  for (double zeta = 0.05e-6; zeta < 5e-6; zeta += 0.0371e-6) {
    const auto reading = read_pressure(curves, state_of(zeta));
    const bool two_fit = zeta >= 2e-6 && zeta <= 3e-6;
    EXPECT_EQ(reading.flags[0], two_fit ? ReadingFlag::ambiguous : 0) << zeta;
  }
}

TEST(ReadPressure, SaysAmbiguousWithinReachOfAFold) {
  const auto curves = folded();
  ReadPressureOptions options;
  options.ambiguity_reach = 2.0;
  constexpr double kSigma = 50e-9;  // reach: 100 nm
  const auto flags = [&](double zeta) {
    return read_pressure(curves, state_of(zeta, kSigma), {}, options).flags[0];
  };
  EXPECT_EQ(flags(1.89e-6), 0);
  EXPECT_EQ(flags(1.91e-6), ReadingFlag::ambiguous);
  EXPECT_EQ(flags(3.09e-6), ReadingFlag::ambiguous);
  EXPECT_EQ(flags(3.11e-6), 0);
}

TEST(ReadPressure, SaysAmbiguousWhereAFoldIsNarrowerThanTheReach) {
  // The fold spans 100 nm, the reach 400 nm to either side: both ends of it lie beyond the fold.
  const auto curves = fit_curves(
      one_station({0.0, 1e3, 2e3, 3e3, 4e3, 5e3}, {0.0, 1e-6, 2e-6, 1.9e-6, 3e-6, 4e-6}, 10e-9));
  for (const double zeta : {1.8e-6, 1.95e-6, 2.1e-6}) {
    EXPECT_EQ(read_pressure(curves, state_of(zeta, 200e-9)).flags[0], ReadingFlag::ambiguous);
  }
  EXPECT_EQ(read_pressure(curves, state_of(3.5e-6, 200e-9)).flags[0], 0);
}

TEST(ReadPressure, SaysAmbiguousOnAFallingEndOfTheCurve) {
  const auto curves = fit_curves(
      one_station({0.0, 1e3, 2e3, 3e3, 4e3}, {-1e-6, -2e-6, -1.5e-6, 1e-6, 2e-6}, 10e-9));
  EXPECT_EQ(read_pressure(curves, state_of(-1.7e-6)).flags[0], ReadingFlag::ambiguous);
  EXPECT_EQ(read_pressure(curves, state_of(0.5e-6)).flags[0], 0);
  EXPECT_EQ(read_pressure(curves, state_of(-0.95e-6, 50e-9)).flags[0], ReadingFlag::ambiguous);
}

TEST(ReadPressure, PassesOnStationsWithoutData) {
  const LocalWall wall;
  const Array1 x = wall.stations(5);
  const auto curves = fit_curves(calibrate(wall, x, log_spaced(12, 100.0, 50e3)));
  auto state = exact_profile(x, [&](double at) { return wall.zeta(at, 3e3); });
  state.flags[2] = StationFlag::no_data;
  state.zeta[2] = 0.0;
  const auto reading = read_pressure(curves, state);
  EXPECT_EQ(reading.flags[2], ReadingFlag::no_data);
  EXPECT_EQ(reading.pressure[2], 0.0);
  EXPECT_TRUE(reading.answered(1) && reading.answered(3));
}

TEST(ReadPressure, SaysInsensitiveWhereTheWallHardlyAnswers) {
  // Slope 1e-10 m/Pa over 10 kPa; 1 % of the range is 10 nm of noise.
  const auto curves = fit_curves(one_station(even(6, 0.0, 10e3), even(6, 0.0, 1e-6)));
  ReadPressureOptions options;
  options.largest_uncertainty = 0.01;
  EXPECT_EQ(read_pressure(curves, state_of(5e-7, 9.9e-9), {}, options).flags[0], 0);
  const auto reading = read_pressure(curves, state_of(5e-7, 10.1e-9), {}, options);
  EXPECT_EQ(reading.flags[0], ReadingFlag::insensitive);
  EXPECT_EQ(reading.pressure[0], 0.0);
  EXPECT_EQ(reading.uncertainty.standard()[0], 0.0);

  const auto rigid = fit_curves(one_station(even(6, 0.0, 10e3), std::vector<double>(6, 0.0)));
  EXPECT_EQ(read_pressure(rigid, state_of(0.0)).flags[0], ReadingFlag::insensitive);
}

TEST(ReadPressure, IntervalHasTheAskedCoverageFactor) {
  const auto curves = fit_curves(one_station(even(6, 0.0, 10e3), even(6, 0.0, 1e-6)));
  ReadPressureOptions options;
  for (const auto& [coverage, factor] :
       {std::pair{0.6826894921, 1.0}, {0.95, 1.959963985}, {0.9973002039, 3.0}}) {
    options.coverage = coverage;
    const auto reading = read_pressure(curves, state_of(5e-7, 10e-9), {}, options);
    EXPECT_NEAR(reading.uncertainty.standard()[0], 100.0, 1e-2);  // 10 nm over 0.1 nm/Pa
    EXPECT_NEAR((reading.upper[0] - reading.pressure[0]) / 100.0, factor, 1e-3);
    EXPECT_NEAR((reading.pressure[0] - reading.lower[0]) / 100.0, factor, 1e-3);
  }
}

TEST(ReadPressure, GaugeErrorsShiftAndScaleTheWholeReading) {
  const LocalWall wall;
  const Array1 x = wall.stations(20);
  const auto levels = calibrate(wall, x, even(24, 1e3, 50e3));  // no noise, and yet the gauge's
  const auto state = exact_profile(x, [&](double at) { return wall.zeta(at, 40e3 - 2e6 * at); });
  const auto reading = read_pressure(fit_curves(levels), state, {0.002, 5.0 * Pa});
  bool has_gain = false, has_zero = false;
  for (const ErrorMode& mode : reading.uncertainty.modes) {
    for (Index ix = 0; ix < x.size(); ++ix) {
      if (mode.variable == "gauge gain") {
        has_gain = true;
        EXPECT_NEAR(mode.effect[ix], 0.002 * reading.pressure[ix], 1e-9);
      } else if (mode.variable == "gauge zero") {
        has_zero = true;
        EXPECT_NEAR(mode.effect[ix], 5.0, 0.05);  // all labels moved alike, but for interpolation
      }
    }
  }
  EXPECT_TRUE(has_gain && has_zero);
}

TEST(ReadPressure, GaugeZeroMovesALevelAtZeroPressureUnlessItWasVented) {
  // A straight curve through levels 2 kPa apart: a reading half way up the first interval leans by
  // a half on the level at 0 Pa, and no reading beyond the first interval does.
  const std::vector<double> pressures = even(6, 0.0, 10e3), zetas = even(6, 0.0, 10e-6);
  const auto zero_effect = [&](double gauge_share, double label_sigma, double zeta) {
    auto levels = one_station(pressures, zetas, 1e-9, label_sigma);
    levels[0].gauge_share = gauge_share;
    const auto reading = read_pressure(fit_curves(levels), state_of(zeta), {0.0, 5.0 * Pa});
    double effect = 0.0;
    for (const ErrorMode& mode : reading.uncertainty.modes) {
      if (mode.variable == "gauge zero") effect += mode.effect[0];
    }
    return effect;
  };
  constexpr double kRoundOff = 1e-7;  // of 10 kPa that go through a cube root and back
  // Labels of unknown noise (0) are no reason for the zero to vanish.
  for (const double label_sigma : {0.0, 10.0}) {
    EXPECT_NEAR(zero_effect(1.0, label_sigma, 1e-6), 5.0, kRoundOff);  // all labels alike
    EXPECT_LT(zero_effect(0.0, label_sigma, 1e-6), 4.0);
    EXPECT_GT(zero_effect(0.0, label_sigma, 1e-6), 1.0);
    // Linear in the share.
    EXPECT_NEAR(zero_effect(0.5, label_sigma, 1e-6),
                0.5 * (5.0 + zero_effect(0.0, label_sigma, 1e-6)), kRoundOff);
    EXPECT_NEAR(zero_effect(1.0, label_sigma, 7e-6), 5.0, kRoundOff);
  }
  // At the vented level itself nothing of the gauge is left.
  EXPECT_NEAR(zero_effect(0.0, 10.0, 1e-12), 0.0, 1e-4);
  EXPECT_NEAR(zero_effect(1.0, 10.0, 1e-12), 5.0, kRoundOff);
}

TEST(ReadPressure, AnErrorThatStateAndCalibrationShareCancels) {
  // One error that lifts every map alike (a mirror's figure) does not move the reading.
  const LocalWall wall;
  const Array1 x = wall.stations(20);
  auto levels = calibrate(wall, x, log_spaced(24, 100.0, 50e3));
  const ErrorMode figure{"mirror", "instrument", Array1::LinSpaced(20, -20e-9, 30e-9)};
  for (Level& each : levels) each.profile.uncertainty.modes.push_back(figure);
  auto state = exact_profile(x, [&](double at) { return wall.zeta(at, 30e3 - 1.5e6 * at); });
  state.uncertainty.modes.push_back(figure);
  const auto reading = read_pressure(fit_curves(levels), state);
  for (const ErrorMode& mode : reading.uncertainty.modes) {
    if (mode.variable != "mirror") continue;
    // Lifting all knots lifts the curve by as much but for its curvature.
    EXPECT_LT((mode.effect * reading.slope).abs().maxCoeff(), 0.02 * 30e-9);
  }
}

TEST(ReadPressure, RefusesOtherStations) {
  const LocalWall wall;
  const auto curves = fit_curves(calibrate(wall, wall.stations(8), even(5, 0.0, 9e3)));
  for (const Array1& other : {wall.stations(9), Array1(wall.stations(8) + 1e-6), Array1()}) {
    EXPECT_THROW(read_pressure(curves, exact_profile(other, [](double) { return 1e-6; })),
                 InputError);
  }
}

TEST(ReadPressureOptions, RefuseValuesOutOfRangeByName) {
  const test::QuietTraps quiet;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto fault = [](auto member, double value) {
    ReadPressureOptions options;
    options.*member = value;
    try {
      options.validate();
    } catch (const InputError& error) {
      return error.where() + " " + error.found() + ". " + error.mend();
    }
    return std::string();
  };
  EXPECT_EQ(fault(&ReadPressureOptions::coverage, 1.0), "--coverage is 1. Give a number in (0, 1)");
  for (const double bad : {0.0, -0.5, 95.0, nan}) {
    EXPECT_NE(fault(&ReadPressureOptions::coverage, bad), "");
  }
  EXPECT_EQ(fault(&ReadPressureOptions::largest_uncertainty, 0.0),
            "--largest-uncertainty is 0. Give a number above 0");
  EXPECT_NE(fault(&ReadPressureOptions::largest_uncertainty, nan), "");
  EXPECT_EQ(fault(&ReadPressureOptions::ambiguity_reach, -1.0),
            "--ambiguity-reach is -1. Give a number of 0 or more");
  EXPECT_NE(fault(&ReadPressureOptions::ambiguity_reach, nan), "");
  EXPECT_EQ(fault(&ReadPressureOptions::ambiguity_reach, 0.0), "");
}

}  // namespace
}  // namespace manoscope::inversion
