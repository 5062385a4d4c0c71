// Roofs of virtual experiments on clamped Foeppl-von Karman walls, whose true shape is at hand.
#include "manoscope/pipeline/roof_of_run.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "manoscope/pipeline/simulate_runs.hpp"
#include "manoscope/pipeline/test_experiment.hpp"
#include "manoscope/twin/scenario_file.hpp"

namespace manoscope::pipeline {
namespace {

/// A shipped scenario through a small camera, at a low and a high flow rate, its wall on few cells.
twin::Scenario scenario_of(const std::string& name) {
  twin::Scenario scenario = twin::find_scenario(name);
  scenario.camera.n_along = 512;
  scenario.camera.n_across = 96;
  scenario.camera.fringe_jumps = 0.0;
  scenario.wall_grid = {20, 8};
  const auto rates = scenario.flow_rates;
  scenario.flow_rates = {rates[1], rates[8]};
  return scenario;
}

class RoofOf : public ::testing::TestWithParam<const char*> {};

TEST_P(RoofOf, AClampedWallIsThatOfTheWallWithinItsErrors) {
  const twin::Scenario scenario = scenario_of(GetParam());
  const twin::SolvedScenario truth = twin::solve_scenario(scenario);
  TestExperiment test(scenario, twin::record_experiment(scenario, truth, 3));
  const experiment::Experiment experiment = test.read();
  const ReadyRuns ready = ready_runs(experiment, {"all"}, station_by_station(), 1, {});
  const flow::Channel channel = channel_of(experiment);
  const double w = channel.width.si();
  const Array1 x = Array1::LinSpaced(101, 0.0, channel.length.si());
  const Array1 z = Array1::LinSpaced(33, -0.48, 0.48) * w;  // where cells lie
  for (std::size_t i = 0; i < ready.calibration.runs.size(); ++i) {
    const FlowRun& run = ready.calibration.runs[i];
    const validation::SmoothShape along(run.profile, channel);
    const RunRoof roof = roof_of_run(run, along, ready.flow, RoofChoice::map_if_told);
    ASSERT_TRUE(roof.map) << roof.words;
    const twin::WallShape& wall = truth.runs[i].flow.wall.shape;
    // Errors of the width average are those of the profile, and none of the shape across.
    const Array1 exact_mean = truth.runs[i].flow.wall.deflection(x);
    const Array2 fitted = roof.map->zeta(x, z);
    const Array1 mean = along.zeta(x);
    const Array1 g = roof.map->modes().at(2.0 / w * z).col(0).array();
    double squares = 0.0, one_shape = 0.0, bars = 0.0;
    const Array2 bar = roof.map->standard(x, z);
    for (Index a = 0; a < x.size(); ++a) {
      for (Index b = 0; b < z.size(); ++b) {
        const double exact = wall(x[a], z[b]) - exact_mean[a] * g[b];
        squares += std::pow(fitted(a, b) - mean[a] * g[b] - exact, 2);
        one_shape += exact * exact;
        bars += bar(a, b) * bar(a, b);
      }
    }
    const auto n = static_cast<double>(x.size() * z.size());
    const double error = std::sqrt(squares / n);
    RecordProperty(run.name + ", error nm", std::to_string(1e9 * error));
    RecordProperty(run.name + ", bar nm", std::to_string(1e9 * std::sqrt(bars / n)));
    RecordProperty(run.name + ", one shape nm", std::to_string(1e9 * std::sqrt(one_shape / n)));
    RecordProperty(run.name + ", words", roof.words);
    // Straight lines between pixels cut (pitch / w)^2 of the mean off the cells of a parabola; off
    // those of a clamped plate, whose curvature is (15/2)(4 - 12 s^2) against 12 of the mean over
    // w^2, 2.2 times as much, rms.
    const double pitch = scenario.camera.rim.si() * 2.0 + w;
    const double cut = std::pow(pitch / scenario.camera.n_across / w, 2) * mean.abs().mean();
    EXPECT_LT(error, 2.0 * std::sqrt(bars / n) + 2.0 * cut) << run.name;
    EXPECT_LT(error, 0.5 * std::sqrt(one_shape / n)) << run.name;
    EXPECT_LT(roof.map->misfit(), 1.3) << run.name;
    EXPECT_LT(std::abs(roof.effect->odd), 1e-4) << run.name;
  }
}

INSTANTIATE_TEST_SUITE_P(OfTheKindOf, RoofOf, ::testing::Values("S1", "S4"));

TEST(RoofOfRun, IsTheOneShapeWhereItIsAskedForOrTheMapTellsNone) {
  twin::Scenario scenario = small_scenario();
  scenario.camera.n_across = 32;  // 22 over the width
  TestExperiment test(scenario);
  const experiment::Experiment experiment = test.read();
  const ReadyRuns ready = ready_runs(experiment, {"all"}, station_by_station(), 1, {});
  const FlowRun& run = ready.calibration.runs.front();
  const validation::SmoothShape along(run.profile, channel_of(experiment));
  const RunRoof coarse = roof_of_run(run, along, ready.flow, RoofChoice::map_if_told);
  EXPECT_FALSE(coarse.map);
  EXPECT_NE(coarse.words.find("too few pixels"), std::string::npos) << coarse.words;
  EXPECT_THROW(roof_of_run(run, along, ready.flow, RoofChoice::map), InputError);
  const RunRoof asked = roof_of_run(run, along, ready.flow, RoofChoice::response);
  EXPECT_FALSE(asked.map);
  EXPECT_EQ(asked.words.find("too few"), std::string::npos) << asked.words;
}

}  // namespace
}  // namespace manoscope::pipeline
