#include "manoscope/twin/virtual_experiment.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <string>
#include <vector>

#include "manoscope/core/error.hpp"
#include "manoscope/flow/channel_resistance.hpp"

namespace manoscope::twin {
namespace {

/// Few pixels and steps, for tests that look at other things.
Scenario tiny() {
  Scenario scenario = small_s1();
  scenario.camera.n_along = 96;
  scenario.camera.n_across = 48;
  return scenario;
}

bool same(const VirtualExperiment& a, const VirtualExperiment& b) {
  bool equal = a.experiment_toml == b.experiment_toml && a.hydrostatic_csv == b.hydrostatic_csv &&
               a.flow_csv == b.flow_csv && truth_csv(a.truth) == truth_csv(b.truth) &&
               a.maps.size() == b.maps.size();
  for (std::size_t i = 0; equal && i < a.maps.size(); ++i) {
    equal = a.maps[i].name == b.maps[i].name &&
            (a.maps[i].map.height() == b.maps[i].map.height()).all() &&
            (a.maps[i].map.flags() == b.maps[i].map.flags()).all();
  }
  return equal;
}

TEST(VirtualExperiment, IsTheSameForTheSameSeedOnOneOrTwoThreads) {
  const VirtualExperiment one = make_virtual_experiment(tiny(), 7, 1);
  EXPECT_TRUE(same(one, make_virtual_experiment(tiny(), 7, 2)));
  EXPECT_FALSE(same(one, make_virtual_experiment(tiny(), 8, 2)));
}

TEST(VirtualExperiment, HoldsAMapForEachLevelAndRun) {
  const Scenario scenario = tiny();
  const VirtualExperiment experiment = make_virtual_experiment(scenario, 1);
  ASSERT_EQ(experiment.maps.size(), 21u);
  EXPECT_EQ(experiment.maps.front().name, "h00.gsf");
  EXPECT_EQ(experiment.maps.back().name, "f03.gsf");
  EXPECT_EQ(experiment.truth.levels.size(), 17u);
  ASSERT_EQ(experiment.truth.runs.size(), 4u);
  EXPECT_EQ(experiment.truth.runs.back().run, "Q70");
  EXPECT_EQ(experiment.truth.x.size(), experiment.truth.runs[0].pressure.size());
}

TEST(VirtualExperiment, TruthAgreesWithItsMaps) {
  Scenario scenario = tiny();
  scenario.camera.n_across = 250;  // exactly 100 um of rim and 1.7 mm in steps of 10 um
  scenario.camera.n_along = 407;
  InterferometerOptions& camera = scenario.camera;
  camera.noise = camera.piston = camera.shift = Length{};
  camera.tilt = Angle{};
  camera.dropouts = camera.blobs = camera.spikes = 0.0;
  const VirtualExperiment experiment = make_virtual_experiment(scenario, 1);
  const auto check = [&](const HeightMap& map, const Array1& zeta) {
    const double pitch = map.grid().pitch_y.si();
    Index first = 0;
    while ((static_cast<double>(first) + 0.5) * map.grid().pitch_x.si() <= camera.rim.si()) ++first;
    for (Index i = 0; i < zeta.size(); ++i) {
      const double average = map.height().col(first + i).sum() * pitch / 1.7e-3;
      // Midpoint rule over whole pixels of a parabola: relative error (pitch/w)^2/2.
      EXPECT_NEAR(average, zeta(i), 0.51 * std::pow(pitch / 1.7e-3, 2) * std::abs(zeta(i)) + 1e-15);
    }
  };
  for (std::size_t i = 0; i < 17; ++i) {
    check(experiment.maps[i].map, experiment.truth.levels[i].deflection);
  }
  for (std::size_t i = 0; i < 4; ++i) {
    check(experiment.maps[17 + i].map, experiment.truth.runs[i].deflection);
  }
}

TEST(VirtualExperiment, LabelsScatterByTheGaugeAndTheVentedLevelIsExact) {
  Scenario scenario = tiny();
  scenario.camera.n_along = scenario.camera.n_across = 8;
  scenario.flow_rates.clear();
  double sum = 0.0, squares = 0.0;
  int n = 0;
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    const VirtualExperiment experiment = make_virtual_experiment(scenario, seed, 1);
    EXPECT_EQ(experiment.truth.levels.front().label.si(), 0.0);
    for (std::size_t i = 1; i < experiment.truth.levels.size(); ++i) {
      const double error =
          (experiment.truth.levels[i].label - experiment.truth.levels[i].pressure).si();
      sum += error;
      squares += error * error;
      ++n;
    }
  }
  // Five standard errors of the mean and the variance of n normal numbers of 10 Pa.
  EXPECT_NEAR(sum / n, 0.0, 5.0 * 10.0 / std::sqrt(n));
  EXPECT_NEAR(squares / n / 100.0, 1.0, 5.0 * std::sqrt(2.0 / n));
}

TEST(VirtualExperiment, GaugeGainAndZeroAreCommonToAllLevels) {
  Scenario scenario = tiny();
  scenario.camera.n_along = scenario.camera.n_across = 8;
  scenario.flow_rates.clear();
  scenario.gauge.noise = Pressure{};
  scenario.gauge.gain_uncertainty = 0.01;
  scenario.gauge.zero_uncertainty = 5.0 * Pa;
  const VirtualExperiment experiment = make_virtual_experiment(scenario, 3);
  const LevelTruth& low = experiment.truth.levels[1];
  const LevelTruth& high = experiment.truth.levels.back();
  const double gain = (high.label - low.label) / (high.pressure - low.pressure);
  const double zero = low.label.si() - gain * low.pressure.si();
  EXPECT_NE(gain, 1.0);
  EXPECT_NE(zero, 0.0);
  for (std::size_t i = 1; i < experiment.truth.levels.size(); ++i) {
    const LevelTruth& level = experiment.truth.levels[i];
    EXPECT_NEAR(level.label.si(), gain * level.pressure.si() + zero, 1e-9);  // round-off of 50 kPa
  }
  EXPECT_EQ(experiment.truth.levels.front().label.si(), 0.0);
}

/// Sum of squares over many draws, against a variance.
class Scatter {
 public:
  void add(double error) {
    sum_ += error;
    squares_ += error * error;
    ++n_;
  }
  /// Five standard errors of the mean and of the variance of n normal numbers.
  void expect(double sigma, const char* what) const {
    EXPECT_NEAR(sum_ / n_ / sigma, 0.0, 5.0 / std::sqrt(n_)) << what;
    EXPECT_NEAR(squares_ / n_ / (sigma * sigma), 1.0, 5.0 * std::sqrt(2.0 / n_)) << what;
  }

 private:
  double sum_ = 0.0, squares_ = 0.0;
  int n_ = 0;
};

/// Nearly rigid, seen by few pixels: gauge and stated height are looked at, hundreds of times.
Scenario bare() {
  Scenario scenario = tiny().without_errors();
  scenario.camera.n_along = scenario.camera.n_across = 8;
  scenario.levels = {1.0 * kPa, 50.0 * kPa};
  scenario.flow_rates = {5.0 * mL_per_min, 7.0 * mL_per_min};
  scenario.wall.thickness = 1.0 * mm;
  scenario.wall.prestress = 1.0 * GPa;
  scenario.wall.preload = {};
  scenario.solver.steps = 20;
  return scenario;
}

/// The gap that the experiment states, m.
double stated_height(const VirtualExperiment& experiment) {
  const std::string& text = experiment.experiment_toml;
  const std::string key = "\nheight = \"";
  return 1e-6 * std::stod(text.substr(text.find(key) + key.size()));
}

TEST(VirtualExperiment, EachErrorOfGaugeAndHeightHasItsStatedScale) {
  Scatter gain, zero, noise, transducer, height;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const auto made = [&](auto change) {
      Scenario scenario = bare();
      change(scenario);
      return make_virtual_experiment(scenario, seed, 1);
    };
    const auto label_error = [](const VirtualExperiment& experiment, std::size_t i) {
      const LevelTruth& level = experiment.truth.levels[i];
      return (level.label - level.pressure).si();
    };
    const auto only_levels = [](Scenario& scenario) { scenario.flow_rates.clear(); };
    const auto with_gain = made([&](Scenario& s) {
      only_levels(s);
      s.gauge.gain_uncertainty = 0.01;
    });
    gain.add(label_error(with_gain, 1) / 50e3);
    EXPECT_NEAR(label_error(with_gain, 0) * 50.0, label_error(with_gain, 1), 1e-6);
    const auto with_zero = made([&](Scenario& s) {
      only_levels(s);
      s.gauge.zero_uncertainty = 5.0 * Pa;
    });
    zero.add(label_error(with_zero, 0));
    EXPECT_NEAR(label_error(with_zero, 0), label_error(with_zero, 1), 1e-9);
    const auto with_noise = made([&](Scenario& s) {
      only_levels(s);
      s.gauge.noise = 8.0 * Pa;
    });
    noise.add(label_error(with_noise, 0));
    noise.add(label_error(with_noise, 1));
    const auto with_height = made([&](Scenario& s) {
      only_levels(s);
      s.height_uncertainty = 0.5 * um;
    });
    height.add(stated_height(with_height) - 175e-6);
  }
  gain.expect(0.01, "gain");
  zero.expect(5.0, "zero");
  noise.expect(8.0, "label noise");
  height.expect(0.5e-6, "stated height");  // printed to 0.01 um
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    Scenario scenario = bare();
    scenario.levels = {Pressure{}};
    scenario.gauge.transducer_noise = 12.0 * Pa;
    for (const RunScalars& run : make_virtual_experiment(scenario, seed, 1).scalars) {
      transducer.add((run.transducer_reading - run.total_drop()).si());
    }
  }
  transducer.expect(12.0, "transducer noise");
}

TEST(VirtualExperiment, EachErrorOfGaugeAndHeightDrawsTheSameAloneAsInCompany) {
  Scenario all = bare();
  all.gauge = {8.0 * Pa, 0.01, 5.0 * Pa, 12.0 * Pa};
  all.height_uncertainty = 0.5 * um;
  all.camera.noise = 20.0 * nm;
  all.pump.pulsation = 0.01;
  const std::uint64_t seed = 5;
  const VirtualExperiment company = make_virtual_experiment(all, seed);
  std::vector<double> labels(all.levels.size(), 0.0);
  const auto alone = [&](auto switch_on) {
    Scenario scenario = bare();
    switch_on(scenario);
    const VirtualExperiment experiment = make_virtual_experiment(scenario, seed);
    for (std::size_t i = 0; i < labels.size(); ++i) {
      labels[i] += (experiment.truth.levels[i].label - experiment.truth.levels[i].pressure).si();
    }
    return experiment;
  };
  alone([&](Scenario& s) { s.gauge.noise = all.gauge.noise; });
  alone([&](Scenario& s) { s.gauge.gain_uncertainty = all.gauge.gain_uncertainty; });
  alone([&](Scenario& s) { s.gauge.zero_uncertainty = all.gauge.zero_uncertainty; });
  for (std::size_t i = 0; i < labels.size(); ++i) {
    const LevelTruth& level = company.truth.levels[i];
    // The three add up to what they do together: round-off of 50 kPa.
    EXPECT_NEAR((level.label - level.pressure).si(), labels[i], 1e-9);
    EXPECT_GT(std::abs(labels[i]), 1e-3);
  }
  const VirtualExperiment transducer =
      alone([&](Scenario& s) { s.gauge.transducer_noise = all.gauge.transducer_noise; });
  for (std::size_t i = 0; i < transducer.scalars.size(); ++i) {
    EXPECT_EQ(transducer.scalars[i].transducer_reading, company.scalars[i].transducer_reading);
    EXPECT_NE(transducer.scalars[i].transducer_reading, transducer.scalars[i].total_drop());
  }
  const VirtualExperiment height =
      alone([&](Scenario& s) { s.height_uncertainty = all.height_uncertainty; });
  EXPECT_EQ(stated_height(height), stated_height(company));
  EXPECT_NE(stated_height(height), 175e-6);
}

TEST(VirtualExperiment, TellsOfEverySnapThroughOfItsWall) {
  // A short nitride wall, compressed to three times what buckles it, bowed in a little.
  Scenario scenario = bare();
  scenario.wall_law = WallLaw::foppl_von_karman;
  scenario.channel.length = scenario.wall.length = 3.0 * mm;
  scenario.wall.thickness = 1.0 * um;
  scenario.wall.preload = {};
  scenario.wall.prestress = -1.6 * MPa;
  scenario.wall.initial_shape = {-0.05 * um, 0.1};
  scenario.wall_grid = {12, 4};
  scenario.solver.steps = 80;
  scenario.levels = {Pressure{}, 0.5 * Pa, 160.0 * Pa, 1.0 * kPa};
  scenario.outlet = {300.0 * Pa, 0.0};
  const VirtualExperiment experiment = make_virtual_experiment(scenario, 1);
  const std::vector<LevelTruth>& levels = experiment.truth.levels;
  for (const std::size_t quiet : {0u, 1u, 3u}) {
    EXPECT_EQ(levels[quiet].snaps.n, 0) << quiet;
    EXPECT_EQ(levels[quiet].snaps.jump, 0.0) << quiet;
  }
  EXPECT_EQ(levels[2].snaps.n, 1);
  EXPECT_GT(levels[2].snaps.jump, 0.1e-6);
  EXPECT_LT(levels[2].snaps.jump,
            levels[2].deflection.maxCoeff() - levels[1].deflection.minCoeff());
  EXPECT_NEAR(levels[2].snaps.at, 1.5e-3, 0.6e-3);
  // Flow lifts the wall from rest, once.
  EXPECT_EQ(experiment.truth.runs[0].snaps.n, 1);
  EXPECT_EQ(experiment.truth.runs[1].snaps.n, 0);
}

TEST(VirtualExperiment, ScalarsAreThoseOfTheirRuns) {
  Scenario scenario = tiny();
  scenario.gauge.transducer_noise = Pressure{};
  const VirtualExperiment experiment = make_virtual_experiment(scenario, 1);
  for (std::size_t i = 0; i < 4; ++i) {
    const RunScalars& run = experiment.scalars[i];
    const RunTruth& truth = experiment.truth.runs[i];
    EXPECT_EQ(run.outlet.si(), 285.0 + 3.1 * run.flow_rate.in(mL_per_min));
    EXPECT_EQ(run.maximum.si(), run.inlet.si());
    EXPECT_GT(run.inlet.si(), truth.pressure(0));
    const double parasitic =
        2.0 *
        flow::passage_drop(scenario.fluid.viscosity, run.flow_rate, *scenario.inlet_passage).si();
    EXPECT_NEAR(run.transducer_reading.si(), (run.inlet - run.outlet).si() + parasitic, 1e-9);
    EXPECT_GE(run.largest_deflection.si(), truth.deflection.maxCoeff() * (1.0 - 1e-9));
    // Q R over the pixels of the truth, second order in 170 um pixels with end layers of 0.54 mm.
    const double resistance =
        flow::resistance_drop(scenario.channel, scenario.fluid.viscosity, run.flow_rate,
                              experiment.truth.x, truth.deflection, Length{},
                              scenario.channel.length, flow::DuctFormula::series)
            .drop.si();
    EXPECT_NEAR(resistance / run.compliant_drop().si(), 1.0, 3e-3);
    EXPECT_NEAR(run.reynolds,
                flow::channel_reynolds(scenario.channel, scenario.fluid, run.flow_rate,
                                       experiment.truth.x, truth.deflection),
                1e-3 * run.reynolds);
  }
}

TEST(VirtualExperiment, ThePumpPulsesInTheMapsNotInTheTruth) {
  Scenario scenario = tiny().without_errors();
  scenario.levels = {Pressure{}};
  const VirtualExperiment steady = make_virtual_experiment(scenario, 4);
  scenario.pump.pulsation = 0.02;
  const WallModel wall = scenario.wall_model();
  const CoupledFlow start =
      fill_channel(scenario.channel, wall, wall.rest(), Pressure{}, scenario.solver);
  double square = 0.0;
  int n = 0;
  for (std::uint64_t seed = 0; seed < 25; ++seed) {
    const VirtualExperiment pulsing = make_virtual_experiment(scenario, seed);
    EXPECT_EQ(truth_csv(pulsing.truth), truth_csv(steady.truth));
    EXPECT_EQ(pulsing.flow_csv, steady.flow_csv);
    EXPECT_TRUE((pulsing.maps[0].map.height() == steady.maps[0].map.height()).all());
    // From the crest back to the flow rate: slope by a difference of the steady coupled flow.
    for (std::size_t i = 0; i < 4; ++i) {
      const Index iy = 24, ix = 48;
      const FlowRate q = scenario.flow_rates[i];
      const double x = 0.5 * scenario.channel.length.si();
      const auto at = [&](double factor) {
        return solve_coupled(scenario.channel, scenario.fluid, wall, start, factor * q,
                             scenario.outlet.pressure(factor * q), scenario.solver)
            .deflection(x);
      };
      const double slope = (at(1.01) - at(0.99)) / 0.02 / at(1.0);
      const double change =
          pulsing.maps[1 + i].map.height()(iy, ix) / steady.maps[1 + i].map.height()(iy, ix) - 1.0;
      square += std::pow(change / slope, 2);
      ++n;
    }
  }
  // Five standard errors of a variance, and 10 % for the curvature of zeta(Q) over 6 %.
  EXPECT_NEAR(square / n / (0.02 * 0.02), 1.0, 0.1 + 5.0 * std::sqrt(2.0 / n));
}

TEST(VirtualExperiment, WithoutErrorsStatesTheTruth) {
  const VirtualExperiment experiment = make_virtual_experiment(small_s1().without_errors(), 9);
  for (const LevelTruth& level : experiment.truth.levels) EXPECT_EQ(level.label, level.pressure);
  for (const RunScalars& run : experiment.scalars) {
    EXPECT_EQ(run.transducer_reading, run.total_drop());
  }
  EXPECT_NE(experiment.experiment_toml.find("height = \"175.00 um\""), std::string::npos);
}

TEST(VirtualExperiment, StopsWhenAskedAndTellsItsProgress) {
  std::atomic<int> n_reports{0};
  Monitor monitor;
  monitor.progress = [&](std::string_view, double fraction) {
    ++n_reports;
    EXPECT_LE(fraction, 1.0);
  };
  make_virtual_experiment(tiny(), 1, 2, monitor);
  EXPECT_EQ(n_reports, 42);  // each is solved, then seen
  monitor.stop_requested = [] { return true; };
  EXPECT_THROW(make_virtual_experiment(tiny(), 1, 2, monitor), Interrupted);
}

TEST(VirtualExperiment, RefusesAChannelThatCloses) {
  Scenario scenario = tiny();
  scenario.channel.height = 8.0 * um;
  scenario.flow_rates = {0.01 * mL_per_min};
  EXPECT_THROW(make_virtual_experiment(scenario, 1), InputError);
}

}  // namespace
}  // namespace manoscope::twin
