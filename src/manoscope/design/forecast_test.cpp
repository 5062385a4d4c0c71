#include "manoscope/design/forecast.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "manoscope/calibration/fit_curves.hpp"
#include "manoscope/core/random.hpp"
#include "manoscope/design/test_apparatus.hpp"
#include "manoscope/inversion/read_pressure.hpp"

namespace manoscope::design {
namespace {

using test_support::bending_plate;
using test_support::bowed_membrane;

constexpr Index kStations = 48;

/// A profile of a wall whose stations all show mid-channel, with drawn noise.
Profile drawn_profile(const Array1& zeta, double noise, RandomStream& stream) {
  Profile profile;
  profile.x = Array1::LinSpaced(kStations, 0.0, 1.0);
  profile.zeta = zeta;
  for (double& one : profile.zeta) one += noise * stream.normal();
  profile.uncertainty.independent = Array1::Constant(kStations, noise);
  profile.flags = Flags1::Zero(kStations);
  return profile;
}

/// Readings of `pressures` with drawn errors, as a measurement makes them.
inversion::PressureReading draw_reading(const Apparatus& apparatus,
                                        const std::vector<double>& levels, const Array1& pressures,
                                        std::uint64_t trial) {
  RandomStream stream(11, "forecast", trial);
  const double gain = apparatus.gauge.gain_uncertainty * stream.normal();
  const double zero = apparatus.gauge.zero_uncertainty.si() * stream.normal();
  std::vector<calibration::Level> drawn;
  for (std::size_t k = 0; k < levels.size(); ++k) {
    const double p = levels[k];
    const bool vented = p == 0.0;
    const double label =
        vented ? 0.0 : (1.0 + gain) * p + zero + apparatus.gauge.noise.si() * stream.normal();
    const Array1 zeta = Array1::Constant(kStations, apparatus.curve.deflection(p));
    drawn.push_back({"h" + std::to_string(k), Pressure::from_si(label),
                     vented ? Pressure{} : apparatus.gauge.noise,
                     drawn_profile(zeta, apparatus.maps.station_noise, stream),
                     vented ? 0.0 : 1.0});
  }
  const Array1 zeta = pressures.unaryExpr([&](double p) { return apparatus.curve.deflection(p); });
  return inversion::read_pressure(
      calibration::fit_curves(std::move(drawn)),
      drawn_profile(zeta, apparatus.maps.station_noise, stream),
      {apparatus.gauge.gain_uncertainty, apparatus.gauge.zero_uncertainty});
}

struct Case {
  std::string name;
  Apparatus apparatus;
  std::vector<double> levels;
  double highest;
};

std::vector<Case> cases() {
  Apparatus exact_gauge = bowed_membrane();
  exact_gauge.gauge.noise = 3.0 * Pa;
  exact_gauge.gauge.gain_uncertainty = 0.002;
  exact_gauge.gauge.zero_uncertainty = 5.0 * Pa;
  return {{"membrane, dense",
           bowed_membrane(),
           {0, 150, 300, 450, 550, 625, 700, 775, 850, 950, 1100, 1400, 2000, 3000, 4500, 7000,
            10000, 14000, 18000},
           17500.0},
          {"plate", bending_plate(), even_levels(14, 0.0, 4200.0, true), 4000.0},
          {"plate, repeats",
           bending_plate(),
           {0, 700, 700, 1400, 1400, 2100, 2100, 2800, 2800, 3500, 3500, 4200, 4200},
           4000.0},
          {"gain and zero", exact_gauge, log_spaced(20, 150.0, 18000.0, true), 17500.0}};
}

TEST(Forecast, TellsErrorsAndBarsOfReadingsToCome) {
  constexpr int kTrials = 300;
  for (Case& one : cases()) {
    one.apparatus.maps.n_stations = kStations;
    one.apparatus.maps.leveling = 0.0;
    const Array1 pressures = Array1::LinSpaced(kStations, 900.0, one.highest);
    const Forecast forecast = forecast_readings(one.apparatus, one.levels, pressures);
    Array1 squares = Array1::Zero(kStations), bars = squares, counts = squares;
    double drops = 0.0, answered_drops = 0.0;
    for (int trial = 0; trial < kTrials; ++trial) {
      const auto reading =
          draw_reading(one.apparatus, one.levels, pressures, static_cast<std::uint64_t>(trial));
      const Array1 standard = reading.uncertainty.standard();
      for (Index i = 0; i < kStations; ++i) {
        ASSERT_TRUE(forecast.answered(i)) << one.name;
        if (!reading.answered(i)) continue;
        squares[i] += std::pow(reading.pressure[i] - pressures[i], 2);
        bars[i] += standard[i] * standard[i];
        counts[i] += 1.0;
      }
      if (!reading.answered(0) || !reading.answered(kStations - 1)) continue;
      const double drop = pressures[kStations - 1] - pressures[0];
      drops += std::pow(reading.pressure[kStations - 1] - reading.pressure[0] - drop, 2);
      answered_drops += 1.0;
    }
    ASSERT_GT(counts.minCoeff(), 0.9 * kTrials) << one.name;
    const double error = std::sqrt((squares / counts).mean());
    const double bar = std::sqrt((bars / counts).mean());
    // A handful of independent errors in each of 300 trials leave 3 %. Drawn labels have weights of
    // their own for the rest of the wall's law: what forecast_readings() promises.
    EXPECT_NEAR(std::sqrt(forecast.error.standard().square().mean()) / error, 1.0, 0.2) << one.name;
    EXPECT_NEAR(std::sqrt(forecast.stated.standard().square().mean()) / bar, 1.0, 0.12) << one.name;
    EXPECT_NEAR(std::sqrt(forecast.uncertainty().square().mean()) / error, 1.0, 0.15) << one.name;
    EXPECT_NEAR(difference(forecast.error, 0, kStations - 1) / std::sqrt(drops / answered_drops),
                1.0, 0.2)
        << one.name;
  }
}

TEST(Forecast, SplitsTheUncertaintyBySource) {
  Apparatus apparatus = bowed_membrane();
  apparatus.gauge.gain_uncertainty = 0.002;
  apparatus.gradient = 1e6;  // Pa/m
  const Array1 pressures = Array1::LinSpaced(7, 1000.0, 17000.0);
  const Forecast forecast =
      forecast_readings(apparatus, log_spaced(24, 150.0, 18000.0, true), pressures);
  Array1 sum = Array1::Zero(7);
  for (const char* source : {"pressure labels", "interpolation", "pixel noise", "leveling",
                             "registration", "gauge zero", "gauge gain"}) {
    sum += by_source(forecast.stated, source).square();
  }
  EXPECT_LT((sum.sqrt() / forecast.stated.standard() - 1.0).abs().maxCoeff(), 1e-12);
  // 0.2 um of a million pascals a metre, 0.2 % of the pressure.
  EXPECT_LT((by_source(forecast.stated, "registration") / 0.2 - 1.0).abs().maxCoeff(), 0.05);
  EXPECT_LT((by_source(forecast.stated, "gauge gain") / (0.002 * pressures) - 1.0).abs().maxCoeff(),
            0.01);
}

TEST(Forecast, TakesRepeatedFlowMapsAndAveragedStationsOffThePixels) {
  Apparatus apparatus = bowed_membrane();
  const std::vector<double> levels = log_spaced(24, 150.0, 18000.0, true);
  const Array1 pressures = Array1::LinSpaced(7, 1000.0, 17000.0);
  const Array1 once =
      by_source(forecast_readings(apparatus, levels, pressures).stated, "pixel noise");
  apparatus.averaging = 0.25;
  const Array1 half =
      by_source(forecast_readings(apparatus, levels, pressures).stated, "pixel noise");
  EXPECT_LT((half / once - 0.5).abs().maxCoeff(), 1e-12);
  apparatus.averaging = 1.0;
  apparatus.flow_maps = 10000;  // what is left is that of the levels
  const Array1 many =
      by_source(forecast_readings(apparatus, levels, pressures).stated, "pixel noise");
  EXPECT_LT((many / once).maxCoeff(), 0.8);
  EXPECT_GT((many / once).minCoeff(), 0.3);
}

TEST(Forecast, HasNoAnswerBeyondTheLevels) {
  const Apparatus apparatus = bowed_membrane();
  Array1 pressures(2);
  pressures << 5000.0, 12000.0;
  const Forecast forecast =
      forecast_readings(apparatus, log_spaced(12, 150.0, 10000.0, true), pressures);
  EXPECT_TRUE(forecast.answered(0));
  EXPECT_FALSE(forecast.answered(1));
  EXPECT_TRUE(std::isinf(forecast.uncertainty()[1]));
}

}  // namespace
}  // namespace manoscope::design
