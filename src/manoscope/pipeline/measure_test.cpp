#include "manoscope/pipeline/measure.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <initializer_list>
#include <tuple>

#include "manoscope/core/flags.hpp"
#include "manoscope/core/options.hpp"
#include "manoscope/core/provenance.hpp"
#include "manoscope/pipeline/judge.hpp"
#include "manoscope/pipeline/test_experiment.hpp"

namespace manoscope::pipeline {
namespace {

using results::Measurement;

bool same_bytes(const Array1& a, const Array1& b) {
  return a.size() == b.size() &&
         (a.size() == 0 || std::memcmp(a.data(), b.data(), sizeof(double) * a.size()) == 0);
}
bool same_bytes(const Array2& a, const Array2& b) {
  return a.rows() == b.rows() && a.cols() == b.cols() &&
         (a.size() == 0 || std::memcmp(a.data(), b.data(), sizeof(double) * a.size()) == 0);
}

/// Every array of the result, and its words.
void expect_same_bytes(const Measurement& a, const Measurement& b) {
  using M = Measurement;
  for (Array1 M::*member : std::initializer_list<Array1 M::*>{&M::x,
                                                              &M::level_pressure,
                                                              &M::level_pressure_uncertainty,
                                                              &M::crest_deflection,
                                                              &M::crest_deflection_uncertainty,
                                                              &M::flow_rate,
                                                              &M::crossing_x,
                                                              &M::crossing_x_uncertainty,
                                                              &M::crossing_pressure,
                                                              &M::extracted_drop,
                                                              &M::extracted_drop_uncertainty,
                                                              &M::resistance_drop,
                                                              &M::resistance_drop_uncertainty,
                                                              &M::channel_resistance_drop,
                                                              &M::predicted_drop,
                                                              &M::inferred_flow_rate,
                                                              &M::reynolds,
                                                              &M::transducer_drop,
                                                              &M::parasitic_drop,
                                                              &M::en_number,
                                                              &M::map_tilt_x,
                                                              &M::map_tilt_z,
                                                              &M::map_noise,
                                                              &M::map_missing,
                                                              &M::map_spikes}) {
    EXPECT_TRUE(same_bytes(a.*member, b.*member));
  }
  for (Array2 M::*member : std::initializer_list<Array2 M::*>{
           &M::static_deflection, &M::static_deflection_uncertainty, &M::deflection,
           &M::deflection_uncertainty, &M::pressure, &M::pressure_uncertainty, &M::pressure_lower,
           &M::pressure_upper, &M::test_section, &M::resistance_pressure, &M::model_drop,
           &M::correction_drop, &M::predicted_pressure}) {
    EXPECT_TRUE(same_bytes(a.*member, b.*member));
  }
  ASSERT_EQ(a.pressure_covariance.size(), b.pressure_covariance.size());
  for (std::size_t r = 0; r < a.pressure_covariance.size(); ++r) {
    EXPECT_TRUE(same_bytes(Array2(a.pressure_covariance[r].array()),
                           Array2(b.pressure_covariance[r].array())));
  }
  ASSERT_EQ(a.pressure_variance.size(), b.pressure_variance.size());
  for (std::size_t s = 0; s < a.pressure_variance.size(); ++s) {
    EXPECT_TRUE(same_bytes(a.pressure_variance[s], b.pressure_variance[s]));
  }
  EXPECT_TRUE((a.pressure_flags == b.pressure_flags).all());
  EXPECT_EQ(a.budget_source, b.budget_source);
  EXPECT_EQ(a.crossing_run, b.crossing_run);
  EXPECT_EQ(a.run, b.run);
  EXPECT_EQ(a.map, b.map);
  ASSERT_EQ(a.map_picture.size(), b.map_picture.size());
  for (std::size_t i = 0; i < a.map_picture.size(); ++i) {
    EXPECT_TRUE((a.map_picture[i].counts == b.map_picture[i].counts).all());
    EXPECT_EQ(a.map_picture[i].step, b.map_picture[i].step);
  }
  EXPECT_EQ(a.inputs, b.inputs);
  EXPECT_EQ(a.settings, b.settings);
  EXPECT_EQ(a.experiment, b.experiment);
  EXPECT_EQ(a.warnings, b.warnings);
}

/// Every run against its truth over the test section.
void expect_near_truth(const Measurement& m, const twin::Truth& truth) {
  const auto judgements = judge(m, truth);
  ASSERT_EQ(judgements.size(), truth.runs.size());
  for (const RunJudgement& run : judgements) {
    // 10 Pa of noise on each label and 5 um of shift of each map: 1 % of the drop, or 20 Pa.
    EXPECT_LE(run.reading.rms, std::max(20.0, 0.01 * run.true_drop)) << run.run;
    EXPECT_LE(std::abs(run.drop_error), std::max(50.0, 0.015 * run.true_drop)) << run.run;
    EXPECT_LE(std::abs(run.drop_pull), 4.0) << run.run;
    EXPECT_EQ(run.reading.n_silent, 0) << run.run;
    EXPECT_NEAR(run.x_start, 1.65e-3, 0.07e-3);  // 3 w/pi from the ends, within a pixel
    EXPECT_NEAR(run.x_end, 13.85e-3, 0.07e-3);
  }
  for (Index r = 0; r < m.flow_rate.size(); ++r) EXPECT_LT(m.en_number[r], 2.0);
}

// ---- Orientation ----

using Orientation = std::tuple<FlowDirection, bool, Outward, bool>;

class Orientations : public ::testing::TestWithParam<Orientation> {};

TEST_P(Orientations, GiveTheTruePressure) {
  const auto [flow, across_reversed, outward, place_given] = GetParam();
  twin::Scenario scenario = small_scenario();
  scenario.camera.flow = flow;
  scenario.camera.across_reversed = across_reversed;
  scenario.camera.outward = outward;
  TestExperiment test(scenario);
  if (!place_given) test.leave_out_place();
  const Measurement m = test.measure();
  expect_near_truth(m, test.twin.truth);
  EXPECT_TRUE(m.warnings.empty()) << all_warnings(m);
  constexpr const char* kFlow[] = {"+columns", "-columns", "+rows", "-rows"};
  EXPECT_NE(m.settings.find(std::string("flow = ") + kFlow[static_cast<int>(flow)]),
            std::string::npos)
      << m.settings;
  EXPECT_NE(
      m.settings.find(outward == Outward::plus_height ? "outward = +height" : "outward = -height"),
      std::string::npos);
  if (place_given) {
    EXPECT_NE(m.settings.find(across_reversed ? "across reversed" : "across forward"),
              std::string::npos);
    EXPECT_LT((m.x - test.twin.truth.x).abs().maxCoeff(), 1e-9);  // ten digits in the file
  }
}

INSTANTIATE_TEST_SUITE_P(
    Given, Orientations,
    ::testing::Combine(::testing::Values(FlowDirection::plus_columns, FlowDirection::minus_columns,
                                         FlowDirection::plus_rows, FlowDirection::minus_rows),
                       ::testing::Bool(),
                       ::testing::Values(Outward::plus_height, Outward::minus_height),
                       ::testing::Values(true)));
INSTANTIATE_TEST_SUITE_P(
    Found, Orientations,
    ::testing::Combine(::testing::Values(FlowDirection::plus_columns, FlowDirection::minus_columns,
                                         FlowDirection::plus_rows, FlowDirection::minus_rows),
                       ::testing::Values(false),
                       ::testing::Values(Outward::plus_height, Outward::minus_height),
                       ::testing::Values(false)));

TEST(Measure, FollowsARotatedChannel) {
  twin::Scenario scenario = small_scenario();
  scenario.camera.rotation = 0.3 * deg;
  // Interpolation loses four samples to each lost pixel: with gaps, stations too.
  scenario.camera.dropouts = scenario.camera.blobs = scenario.camera.spikes = 0.0;
  TestExperiment test(scenario);
  expect_near_truth(test.measure(), test.twin.truth);
}

// ---- What must not matter ----

TEST(Measure, IsTheSameOnOneOrTwoThreads) {
  TestExperiment test;
  const auto experiment = test.read();
  expect_same_bytes(measure(experiment, {}, 1), measure(experiment, {}, 2));
}

TEST(Measure, DoesNotCareForTheOrderOfTheLists) {
  TestExperiment test;
  const auto experiment = test.read();
  auto shuffled = experiment;
  std::reverse(shuffled.hydrostatic.begin() + 3, shuffled.hydrostatic.end());
  std::swap(shuffled.hydrostatic[0], shuffled.hydrostatic[7]);
  std::swap(shuffled.flow[0], shuffled.flow[1]);
  const Measurement a = measure(experiment), b = measure(shuffled);
  EXPECT_TRUE(same_bytes(a.static_deflection, b.static_deflection));
  EXPECT_TRUE(same_bytes(a.crest_deflection, b.crest_deflection));
  EXPECT_EQ(b.run, (std::vector<std::string>{"Q70", "Q20"}));  // as the list has them
  for (const Index r : {0, 1}) {
    EXPECT_TRUE(same_bytes(Array1(a.pressure.row(r)), Array1(b.pressure.row(1 - r))));
    EXPECT_TRUE(same_bytes(Array1(a.pressure_uncertainty.row(r)),
                           Array1(b.pressure_uncertainty.row(1 - r))));
  }
}

// ---- Instrument ----

TEST(Measure, SubtractsTheInstrumentsReference) {
  TestExperiment plain;
  const Measurement without = plain.measure();
  TestExperiment test;
  const CameraGrid grid = test.twin.maps[0].map.grid();
  Array2 bow(grid.ny, grid.nx);  // 2 um of bow along the map: no plane takes it away
  for (Index iy = 0; iy < grid.ny; ++iy) {
    for (Index ix = 0; ix < grid.nx; ++ix) {
      const double u = 2.0 * static_cast<double>(ix) / static_cast<double>(grid.nx) - 1.0;
      bow(iy, ix) = 2e-6 * u * u;
    }
  }
  for (auto& named : test.twin.maps) {
    named.map = HeightMap(grid, named.map.height() + bow, named.map.flags());
  }
  const Measurement bowed = test.measure();
  test.replace("[instrument]\n", "[instrument]\nreference = \"flat.gsf\"\n");
  io::write_map(test.folder() / "flat.gsf", HeightMap(grid, bow), "flat");
  const Measurement m = test.measure();
  // 32-bit floats of up to 80 um: 5 pm a pixel.
  EXPECT_LT((m.deflection - without.deflection)
                .isNaN()
                .select(0.0, m.deflection - without.deflection)
                .abs()
                .maxCoeff(),
            50e-12);
  const Index middle = m.x.size() / 2;
  EXPECT_GT(std::abs(bowed.deflection(0, middle) - without.deflection(0, middle)), 200e-9);
  EXPECT_NE(m.inputs.find("flat.gsf  " + sha256(read_file(test.folder() / "flat.gsf"))),
            std::string::npos)
      << m.inputs;
}

TEST(Measure, TakesTheStatedNoiseAndElseEstimatesIt) {
  twin::Scenario scenario = small_scenario();
  // Gaps add their sag to this line of the budget.
  scenario.camera.dropouts = scenario.camera.blobs = scenario.camera.spikes = 0.0;
  TestExperiment test(scenario);
  const Measurement given = test.measure();
  test.remove_line("height_noise");
  const Measurement estimated = test.measure();
  test.replace("[instrument]\n", "[instrument]\nheight_noise = \"200 nm\"\n");
  const Measurement large = test.measure();
  const Index middle = given.x.size() / 2;
  for (const Index r : {0, 1}) {
    // The rim holds about 9000 pixels: the estimate of 20 nm is good to 1 or 2 %.
    EXPECT_NEAR(
        estimated.deflection_uncertainty(r, middle) / given.deflection_uncertainty(r, middle), 1.0,
        0.05);
    EXPECT_GT(large.deflection_uncertainty(r, middle), given.deflection_uncertainty(r, middle));
  }
  const auto noise = [&](const Measurement& m) {
    return m.pressure_variance[static_cast<std::size_t>(
        std::find(m.budget_source.begin(), m.budget_source.end(), "pixel noise") -
        m.budget_source.begin())](1, middle);
  };
  EXPECT_NEAR(noise(large) / noise(given), 100.0, 5.0);  // ten times the noise, squared
  for (Index i = 0; i < given.map_noise.size(); ++i) {
    EXPECT_NEAR(given.map_noise[i], 20e-9, 1.5e-9);  // measured, whatever is stated
  }
}

// ---- Shapes of experiments ----

TEST(Measure, WithoutFlowGivesTheCalibration) {
  twin::Scenario scenario = small_scenario();
  scenario.flow_rates.clear();
  TestExperiment test(scenario);
  const Measurement m = test.measure();
  EXPECT_EQ(m.flow_rate.size(), 0);
  EXPECT_EQ(m.pressure.rows(), 0);
  EXPECT_EQ(m.crossing_x.size(), 0);
  EXPECT_TRUE(m.run.empty());
  EXPECT_EQ(m.static_deflection.rows(), 17);
  EXPECT_TRUE(m.warnings.empty()) << all_warnings(m);
  for (std::size_t k = 0; k < test.twin.truth.levels.size(); ++k) {
    const Array1 error = Array1(m.static_deflection.row(static_cast<Index>(k))) -
                         test.twin.truth.levels[k].deflection;
    // 20 nm over 43 pixels is 3 nm, the plane as much, and 64 pixels across err by d^2/12 of the
    // parabola's edge slopes: 0.1 %.
    const double largest = test.twin.truth.levels[k].deflection.abs().maxCoeff();
    for (Index ix = 30; ix < error.size() - 30; ++ix) {
      if (std::isnan(error[ix])) continue;  // a station in a gap
      EXPECT_LT(std::abs(error[ix]), 25e-9 + 2e-3 * largest) << k << " at " << ix;
    }
  }
}

TEST(Measure, WithoutFlowFindsThePlaceToo) {
  twin::Scenario scenario = small_scenario();
  scenario.flow_rates.clear();
  TestExperiment test(scenario);
  test.leave_out_place();
  EXPECT_EQ(test.measure().static_deflection.rows(), 17);
}

TEST(Measure, AddsUpTheRigidPassages) {
  TestExperiment test;
  const Measurement m = test.measure();
  for (Index r = 0; r < 2; ++r) {
    const auto& scalars = test.twin.scalars[static_cast<std::size_t>(r)];
    EXPECT_NEAR(m.parasitic_drop[r] / scalars.parasitic.si(), 1.0, 1e-9);
    EXPECT_NEAR(m.transducer_drop[r], scalars.transducer_reading.si(),
                0.051);  // a tenth in the list
    EXPECT_NEAR(m.reynolds[r] / scalars.reynolds, 1.0, 2e-3);
  }
  const auto at = test.twin.experiment_toml.find("outlet = {");
  test.twin.experiment_toml.erase(at);
  EXPECT_NEAR(test.measure().parasitic_drop[1] / m.parasitic_drop[1], 0.5, 1e-9);
  test.twin.experiment_toml.erase(test.twin.experiment_toml.find("[rigid]"));
  EXPECT_TRUE(std::isnan(test.measure().parasitic_drop[1]));
}

TEST(Measure, WithoutATransducerHasNaNThere) {
  TestExperiment test;
  test.twin.flow_csv = "map,flow_rate [mL/min]\nf00.gsf,20\nf01.gsf,70\n";
  const Measurement m = test.measure();
  EXPECT_TRUE(std::isnan(m.transducer_drop[0]));
  EXPECT_EQ(m.run, (std::vector<std::string>{"f00", "f01"}));
}

// ---- Stopping and telling ----

TEST(Measure, StopsWhenAsked) {
  TestExperiment test;
  const auto experiment = test.read();
  for (const int n_threads : {1, 2}) {
    for (const int after : {0, 5, 19}) {
      std::atomic<int> asked{0};
      Monitor monitor;
      monitor.stop_requested = [&] { return asked++ >= after; };
      EXPECT_THROW(measure(experiment, {}, n_threads, monitor), Interrupted) << after;
    }
  }
}

TEST(Measure, ReportsProgressUpToTheEnd) {
  TestExperiment test;
  std::vector<std::string> stages;
  double most = 0.0;
  Monitor monitor;
  monitor.progress = [&](std::string_view stage, double fraction) {
    if (stages.empty() || stages.back() != stage) stages.emplace_back(stage);
    EXPECT_GE(fraction, 0.0);
    EXPECT_LE(fraction, 1.0);
    if (stage == "reducing maps") most = std::max(most, fraction);
  };
  measure(test.read(), {}, 1, monitor);
  EXPECT_EQ(stages,
            (std::vector<std::string>{"finding the channel", "reducing maps", "solving the wall",
                                      "reading p(x)", "checking without truth"}));
  EXPECT_EQ(most, 1.0);
}

TEST(Measure, SaysHowItReadAndKeepsTheLocalReadingBesideIt) {
  TestExperiment test;
  const Measurement off = test.measure();
  EXPECT_EQ(off.reading, "every station on its own: switched off");
  EXPECT_TRUE(same_bytes(off.pressure, off.pressure_local));
  EXPECT_TRUE(off.half_response_wavelength.isNaN().all());
  // This wall answers at x alone, with end layers of the wrong form: no clamped plate is like it.
  const Measurement refused = test.measure(MeasureOptions{});
  EXPECT_EQ(refused.reading.find("every station on its own: a uniform clamped wall is off by"), 0U)
      << refused.reading;
  EXPECT_TRUE(same_bytes(refused.pressure, off.pressure));
  test.remove_line("thickness");
  const Measurement unknown = test.measure(MeasureOptions{});
  EXPECT_EQ(unknown.reading,
            "every station on its own: the experiment does not tell wall.thickness");
}

TEST(Measure, TellsEveryOptionAndEveryInput) {
  TestExperiment test;
  MeasureOptions options = station_by_station();
  options.reading.coverage = 0.68;
  options.section.start = 2.0 * mm;
  options.intersections.window = 0.2 * mm;
  const Measurement m = test.measure(options);
  int n_options = 0;
  options.describe([&](const char* name, auto& value, const char*) {
    const std::string line = std::string(name) + " = " + option_text::write(value) + "\n";
    EXPECT_NE(("\n" + m.settings).find("\n" + line), std::string::npos) << line;
    ++n_options;
  });
  EXPECT_EQ(n_options, 29);
  for (const char* line :
       {"coverage = 0.68\n", "section-start = 0.002 m\n", "section-end = auto\n"}) {
    EXPECT_NE(m.settings.find(line), std::string::npos) << line << m.settings;
  }
  EXPECT_EQ(m.coverage, 0.68);
  EXPECT_GE(m.test_section(0, 0), 2e-3);
  EXPECT_LT(m.test_section(0, 0), 2.07e-3);
  EXPECT_EQ(m.experiment, test.twin.experiment_toml);
  std::string inputs;
  for (const auto& map : test.twin.maps) {
    inputs += map.name + "  " + sha256(read_file(test.folder() / map.name)) + "\n";
  }
  EXPECT_EQ(m.inputs, inputs);
  EXPECT_EQ(m.map.size(), test.twin.maps.size());
  EXPECT_NE(m.title.find("small"), std::string::npos);
  EXPECT_NE(m.source.find(std::string(program_version())), std::string::npos);
  EXPECT_EQ(m.channel_height_uncertainty, 0.5e-6);
  EXPECT_DOUBLE_EQ(m.viscosity, 1e-3);
}

TEST(Measure, RefusesOptionsOutOfRangeByName) {
  TestExperiment test;
  const auto experiment = test.read();
  const auto refused = [&](auto&& change, const std::string& name) {
    MeasureOptions options;
    change(options);
    try {
      measure(experiment, options);
      FAIL() << name;
    } catch (const InputError& error) {
      EXPECT_EQ(error.where(), name);
    }
  };
  refused([](auto& o) { o.reduce.spike_threshold = 1.0; }, "--spike-threshold");
  refused([](auto& o) { o.curves.pooling = -1.0; }, "--pooling");
  refused([](auto& o) { o.reading.coverage = 1.0; }, "--coverage");
  refused([](auto& o) { o.section.clearance = -1.0; }, "--clearance");
  refused([](auto& o) { o.intersections.window = Length{}; }, "--crossing-window");
}

}  // namespace
}  // namespace manoscope::pipeline
