// Plans tried on virtual experiments: what was forecast comes out, and the planned levels serve
// better than as many in equal ratios.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "manoscope/design/plan.hpp"
#include "manoscope/experiment/experiment.hpp"
#include "manoscope/pipeline/judged_stretch.hpp"
#include "manoscope/pipeline/measure.hpp"
#include "manoscope/twin/experiment_files.hpp"
#include "manoscope/twin/virtual_experiment.hpp"
#include "tests/support/temporary_folder.hpp"

namespace manoscope {
namespace {

/// What came out of many experiments, run by run, root mean squares in Pa.
struct Outcome {
  Array1 error;     ///< of p(x), over the test section
  Array1 bar;       ///< as stated
  Array1 at_inlet;  ///< error of the mean over the first sixth of the test section
};

/// Errors of p(x) in one experiment after the other.
class Tally {
 public:
  explicit Tally(Index n_runs)
      : squares_(Array1::Zero(n_runs)), bars_(squares_), inlet_(squares_), counts_(squares_) {}

  void add(const results::Measurement& m, Index r, const Array1& truth,
           const inversion::Stretch& stretch) {
    const double start = stretch.start.si(), end = stretch.end.si();
    double sum = 0.0, count = 0.0;
    for (Index i = 0; i < m.x.size(); ++i) {
      const bool inside = m.x[i] >= start && m.x[i] <= end;
      if (!inside || !std::isfinite(m.pressure(r, i))) continue;
      const double off = m.pressure(r, i) - truth[i];
      squares_[r] += off * off;
      bars_[r] += std::pow(m.pressure_uncertainty(r, i), 2);
      counts_[r] += 1.0;
      if (m.x[i] > start + (end - start) / 6.0) continue;
      sum += off;
      count += 1.0;
    }
    inlet_[r] += std::pow(sum / count, 2);
  }
  Outcome outcome(int n) const {
    return {(squares_ / counts_).sqrt(), (bars_ / counts_).sqrt(), (inlet_ / n).sqrt()};
  }

 private:
  Array1 squares_, bars_, inlet_, counts_;
};

/// Every station is read on its own: a plate's neighbourhood is no part of the forecast.
Outcome try_levels(twin::Scenario scenario, const std::vector<double>& levels, int n_seeds) {
  scenario.levels.clear();
  for (const double level : levels) scenario.levels.push_back(Pressure::from_si(level));
  const auto solved = twin::solve_scenario(scenario);
  const auto stretch = inversion::wanted_stretch(scenario.channel.length, scenario.channel.width);
  const test_support::TemporaryFolder folder;
  pipeline::MeasureOptions options;
  options.nonlocal.nonlocal = false;
  options.flow.flow_models = false;
  Tally tally(static_cast<Index>(scenario.flow_rates.size()));
  for (int seed = 1; seed <= n_seeds; ++seed) {
    const auto made = twin::record_experiment(scenario, solved, static_cast<std::uint64_t>(seed));
    twin::write_experiment(folder.path(), made, true);
    const auto m = pipeline::measure(experiment::read_experiment(folder.path()), options);
    for (Index r = 0; r < m.flow_rate.size(); ++r) {
      const auto& run = made.truth.runs[static_cast<std::size_t>(r)];
      tally.add(m, r, pipeline::interpolate(made.truth.x, run.pressure, m.x), stretch);
    }
  }
  return tally.outcome(n_seeds);
}

/// What was forecast of every run, against what came out.
void expect_forecast(const design::LevelSet& set, const Outcome& found, double tolerance) {
  for (std::size_t r = 0; r < set.runs.size(); ++r) {
    const auto i = static_cast<Index>(r);
    EXPECT_NEAR(set.runs[r].rms / found.error[i], 1.0, tolerance)
        << set.name << " " << set.runs[r].name;
  }
}

double together(const Array1& values) { return std::sqrt(values.square().mean()); }

twin::Scenario small_camera(twin::Scenario scenario, int n_along) {
  scenario.camera.n_along = n_along;
  scenario.camera.n_across = 48;
  scenario.camera.blobs = 0.0;
  // Anywhere within half a pixel.
  const Length pitch = (scenario.channel.length + 2.0 * scenario.camera.rim) / n_along;
  scenario.camera.shift = pitch * (1.0 / std::sqrt(12.0));
  return scenario;
}

TEST(PlannedTwin, OfABowedMembraneReadsBetterThanLogSpacedLevels) {
  constexpr int kSeeds = 24;
  twin::ScenarioDraft draft;
  draft.scenario = small_camera(twin::small_s1(), 512);
  draft.scenario.flow_rates = {5.0 * mL_per_min, 20.0 * mL_per_min};
  design::Wish wish;
  wish.levels = 12;
  const design::Plan plan = design::make_plan(draft, wish);
  const design::LevelSet& log = plan.others.front();
  const Outcome planned = try_levels(plan.scenario, plan.planned.levels, kSeeds);
  const Outcome by_habit = try_levels(plan.scenario, log.levels, kSeeds);
  // Some five free numbers in each experiment: 7 %, three times.
  constexpr double kTolerance = 0.2;
  expect_forecast(plan.planned, planned, kTolerance);
  expect_forecast(log, by_habit, kTolerance);
  EXPECT_LT(together(planned.error), 0.75 * together(by_habit.error));
  // So are the bars, where levels stand close enough that interpolation tells its own error.
  EXPECT_NEAR(together(planned.bar) / together(planned.error), 1.0, kTolerance);
}

TEST(PlannedTwin, OfASoftPlateReadsTheHighestPressuresBetter) {
  constexpr int kSeeds = 40;
  twin::ScenarioDraft draft;
  twin::Scenario& scenario = draft.scenario;
  scenario = twin::small_s1();
  scenario.name = "soft plate";
  scenario.channel = {10.0 * mm, 1.0 * mm, 200.0 * um};
  scenario.wall = {10.0 * mm, 1.0 * mm, 100.0 * um, 1.5 * MPa, 0.49, 20.0 * kPa, 5.0 / 6.0};
  scenario.wall_law = twin::WallLaw::foppl_von_karman;
  scenario.wall_grid = {12, 4};
  scenario.levels = {Pressure{}};
  scenario.flow_rates = {5.0 * mL_per_min, 12.0 * mL_per_min};
  scenario = small_camera(scenario, 256);
  design::Wish wish;
  wish.levels = 14;
  wish.minimise = "worst";
  const design::Plan plan = design::make_plan(draft, wish);
  const design::LevelSet& log = plan.others.front();
  const Outcome planned = try_levels(plan.scenario, plan.planned.levels, kSeeds);
  const Outcome by_habit = try_levels(plan.scenario, log.levels, kSeeds);
  // Some five free numbers in each experiment: 5 %, three times; and locality.
  constexpr double kTolerance = 0.2;
  expect_forecast(plan.planned, planned, kTolerance);
  expect_forecast(log, by_habit, kTolerance);
  // Levels in equal ratios leave the highest pressures to one of them.
  EXPECT_LT(planned.at_inlet[1], 0.8 * by_habit.at_inlet[1]);
}

}  // namespace
}  // namespace manoscope
