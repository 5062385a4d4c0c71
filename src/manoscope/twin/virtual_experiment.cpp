#include "manoscope/twin/virtual_experiment.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>

#include "manoscope/core/error.hpp"
#include "manoscope/core/parallel.hpp"
#include "manoscope/core/random.hpp"
#include "manoscope/flow/channel_resistance.hpp"
#include "manoscope/twin/experiment_files.hpp"

namespace manoscope::twin {
namespace {

/// Gauge readings of all levels, from one draw of gain and zero.
std::vector<LevelTruth> read_gauge(const Scenario& scenario, std::uint64_t seed) {
  const GaugeOptions& gauge = scenario.gauge;
  const double gain = gauge.gain_uncertainty * RandomStream(seed, "gauge gain").normal();
  const Pressure zero = RandomStream(seed, "gauge zero").normal() * gauge.zero_uncertainty;
  std::vector<LevelTruth> levels;
  for (std::size_t i = 0; i < scenario.levels.size(); ++i) {
    LevelTruth level;
    level.map = fmt::format("h{:02d}.gsf", i);
    level.pressure = scenario.levels[i];
    if (level.pressure > Pressure{}) {
      const double noise = RandomStream(seed, "gauge noise", i).normal();
      level.label = (1.0 + gain) * level.pressure + zero + noise * gauge.noise;
    }
    levels.push_back(std::move(level));
  }
  return levels;
}

Pressure parasitic_drop(const Scenario& scenario, FlowRate flow_rate) {
  Pressure drop{};
  for (const auto& passage : {scenario.inlet_passage, scenario.outlet_passage}) {
    if (passage) drop += flow::passage_drop(scenario.fluid.viscosity, flow_rate, *passage);
  }
  return drop;
}

RunScalars run_scalars(const Scenario& scenario, FlowRate flow_rate, const CoupledFlow& flow,
                       double transducer_noise) {
  RunScalars run;
  run.flow_rate = flow_rate;
  run.inlet = flow.inlet();
  run.outlet = flow.outlet();
  run.maximum = Pressure::from_si(flow.pressure.values().maxCoeff());
  run.parasitic = parasitic_drop(scenario, flow_rate);
  run.transducer_reading = run.total_drop() + transducer_noise * scenario.gauge.transducer_noise;
  const Array1& zeta = flow.deflection.values();
  run.largest_deflection = Length::from_si(zeta.maxCoeff());
  run.speed_index = flow.speed_index;
  run.reynolds = flow::channel_reynolds(scenario.channel, scenario.fluid, flow_rate,
                                        flow.deflection.x(), zeta);
  return run;
}

/// What the camera is to see, and the name it goes by.
struct Scene {
  WallShape shape;
  std::string name, title;
};

/// Levels: their scenes, and their truth into the experiment.
void film_levels(const Scenario& scenario, const SolvedScenario& solved,
                 VirtualExperiment& experiment, std::vector<Scene>& scenes) {
  for (std::size_t i = 0; i < solved.levels.size(); ++i) {
    const WallAtRest& wall = solved.levels[i].wall;
    LevelTruth& level = experiment.truth.levels[i];
    level.snaps = solved.levels[i].snaps;
    level.deflection = wall.deflection(experiment.truth.x);
    Array1 compliance = wall.compliance(experiment.truth.x);
    if (compliance.isFinite().all()) level.compliance = std::move(compliance);
    scenes.push_back({wall.shape, level.map,
                      fmt::format("{} hydrostatic {:g} Pa", scenario.name, level.pressure.si())});
  }
}

/// The same of the runs.
void film_runs(const Scenario& scenario, const SolvedScenario& solved, std::uint64_t seed,
               const Monitor& monitor, VirtualExperiment& experiment, std::vector<Scene>& scenes) {
  for (std::size_t run = 0; run < solved.runs.size(); ++run) {
    const FlowRate flow_rate = scenario.flow_rates[run];
    const CoupledFlow& flow = solved.runs[run].flow;
    const Array1& x = experiment.truth.x;
    experiment.truth.runs.push_back(
        {run_label(flow_rate), flow.pressure(x), flow.wall.deflection(x), solved.runs[run].snaps});
    const double noise = RandomStream(seed, "transducer noise", run).normal();
    experiment.scalars.push_back(run_scalars(scenario, flow_rate, flow, noise));
    WallShape shape = flow.wall.shape;
    if (scenario.pump.pulsation > 0.0) {
      const double n = RandomStream(seed, "pump pulsation", run).normal();
      const FlowRate momentary = (1.0 + scenario.pump.pulsation * n) * flow_rate;
      shape = solve_nearby(scenario, solved, flow, momentary, monitor).wall.shape;
    }
    scenes.push_back({std::move(shape), fmt::format("f{:02d}.gsf", run),
                      fmt::format("{} flow {:g} mL/min", scenario.name, flow_rate.in(mL_per_min))});
  }
}

}  // namespace

VirtualExperiment record_experiment(const Scenario& scenario, const SolvedScenario& solved,
                                    std::uint64_t seed, int n_threads, const Monitor& monitor,
                                    const std::function<void()>& done) {
  scenario.validate();
  MANO_ASSERT(solved.levels.size() == scenario.levels.size());
  MANO_ASSERT(solved.runs.size() == scenario.flow_rates.size());
  VirtualExperiment experiment;
  experiment.header = {
      experiment_name(scenario, seed), seed, scenario.channel, {}, scenario.solver.flow_model,
      scenario.solver.inlet_profile};
  experiment.truth.x = pixel_stations(scenario.channel, scenario.camera);
  experiment.truth.levels = read_gauge(scenario, seed);
  std::vector<Scene> scenes;
  film_levels(scenario, solved, experiment, scenes);
  film_runs(scenario, solved, seed, monitor, experiment, scenes);

  std::vector<std::optional<NamedMap>> maps(scenes.size());
  parallel_for(static_cast<Index>(scenes.size()), n_threads, [&](Index i) {
    monitor.checkpoint();
    const auto index = static_cast<std::size_t>(i);
    const Scene& scene = scenes[index];
    maps[index] = NamedMap{scene.name, scene.title,
                           record_map(scenario.channel, scene.shape, scenario.camera, seed, index)};
    if (done) done();
  });
  for (std::optional<NamedMap>& map : maps) experiment.maps.push_back(*std::move(map));

  const double height_error = RandomStream(seed, "stated height").normal();
  experiment.experiment_toml =
      experiment_toml(scenario, experiment.header.name,
                      scenario.channel.height + height_error * scenario.height_uncertainty);
  experiment.hydrostatic_csv = hydrostatic_csv(scenario, experiment.truth.levels);
  experiment.flow_csv = flow_csv(experiment.scalars);
  return experiment;
}

VirtualExperiment make_virtual_experiment(const Scenario& scenario, std::uint64_t seed,
                                          int n_threads, const Monitor& monitor) {
  scenario.validate();
  const std::size_t n_scenes = scenario.levels.size() + scenario.flow_rates.size();
  std::atomic<std::size_t> n_done{0};
  const auto done = [&] {
    monitor.report("virtual experiment",
                   static_cast<double>(++n_done) / static_cast<double>(2 * n_scenes));
  };
  const SolvedScenario solved = solve_scenario(scenario, n_threads, monitor, done);
  return record_experiment(scenario, solved, seed, n_threads, monitor, done);
}

}  // namespace manoscope::twin
