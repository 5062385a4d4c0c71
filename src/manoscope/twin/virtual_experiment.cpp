#include "manoscope/twin/virtual_experiment.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
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

/// What snapped on the way from one state of a wall to a later one.
SnapTruth snaps_between(const WallAtRest& before, const WallAtRest& now) {
  SnapTruth found;
  for (std::size_t i = before.snaps.size(); i < now.snaps.size(); ++i) {
    const WallSnap& snap = now.snaps[i];
    ++found.n;
    if (std::abs(snap.jump) > std::abs(found.jump)) {
      found.jump = snap.jump;
      found.at = snap.at;
    }
  }
  return found;
}

/// What the camera is to see, and the name it goes by.
struct Scene {
  WallShape shape;
  std::string name, title;
};

/// Solves a scenario for the wall of each level and run, in the order in which an experimenter
/// meets them: the wall remembers where it comes from.
class Walls {
 public:
  Walls(const Scenario& scenario, std::uint64_t seed, const Monitor& monitor,
        VirtualExperiment& experiment)
      : scenario_(scenario),
        seed_(seed),
        monitor_(monitor),
        experiment_(experiment),
        model_(scenario.wall_model(monitor)),
        rest_(model_.rest()) {}

  /// Levels one after the other: their scenes, and their truth into the experiment.
  void fill(std::vector<Scene>& scenes, const std::function<void()>& done) {
    CoupledFlow now = still(rest_, Pressure{});
    for (LevelTruth& level : experiment_.truth.levels) {
      monitor_.checkpoint();
      CoupledFlow next = still(now.wall, level.pressure);
      level.snaps = snaps_between(now.wall, next.wall);
      now = std::move(next);
      level.deflection = now.wall.deflection(experiment_.truth.x);
      Array1 compliance = now.wall.compliance(experiment_.truth.x);
      if (compliance.isFinite().all()) level.compliance = std::move(compliance);
      scenes.push_back(
          {now.wall.shape, level.map,
           fmt::format("{} hydrostatic {:g} Pa", scenario_.name, level.pressure.si())});
      done();
    }
  }

  /// The same of the runs.
  void flow(std::vector<Scene>& scenes, const std::function<void()>& done) {
    CoupledFlow now = still(rest_, Pressure{});
    for (std::size_t run = 0; run < scenario_.flow_rates.size(); ++run) {
      monitor_.checkpoint();
      const FlowRate flow_rate = scenario_.flow_rates[run];
      CoupledFlow next = flowing(now, flow_rate);
      const SnapTruth snaps = snaps_between(now.wall, next.wall);
      now = std::move(next);
      const Array1& x = experiment_.truth.x;
      experiment_.truth.runs[run] = {run_label(flow_rate), now.pressure(x), now.wall.deflection(x),
                                     snaps};
      const double noise = RandomStream(seed_, "transducer noise", run).normal();
      experiment_.scalars[run] = run_scalars(scenario_, flow_rate, now, noise);
      WallShape shape = now.wall.shape;
      if (scenario_.pump.pulsation > 0.0) {
        const double n = RandomStream(seed_, "pump pulsation", run).normal();
        shape = flowing(now, (1.0 + scenario_.pump.pulsation * n) * flow_rate).wall.shape;
      }
      scenes.push_back(
          {std::move(shape), fmt::format("f{:02d}.gsf", run),
           fmt::format("{} flow {:g} mL/min", scenario_.name, flow_rate.in(mL_per_min))});
      done();
    }
  }

 private:
  CoupledFlow still(const WallAtRest& from, Pressure pressure) const {
    return named(fmt::format("the level of {:g} Pa", pressure.si()), [&] {
      return fill_channel(scenario_.channel, model_, from, pressure, scenario_.solver);
    });
  }
  CoupledFlow flowing(const CoupledFlow& from, FlowRate flow_rate) const {
    return named(run_label(flow_rate), [&] {
      return solve_coupled(scenario_.channel, scenario_.fluid, model_, from, flow_rate,
                           scenario_.outlet.pressure(flow_rate), scenario_.solver, monitor_);
    });
  }
  /// What solve() gives; its faults name the scenario and where in it they came up.
  template <class Solve>
  CoupledFlow named(const std::string& where, Solve solve) const {
    try {
      CoupledFlow flow = solve();
      check_rise(flow.wall.shape);
      return flow;
    } catch (const InputError& error) {
      throw InputError(fmt::format("scenario \"{}\", {}", scenario_.name, where), error.found(),
                       error.mend());
    }
  }

  /// Refuses a wall whose crest is found beyond what its law holds for.
  void check_rise(const WallShape& shape) const {
    const double half_width = 0.5 * std::min(scenario_.wall.width, scenario_.wall.length).si();
    for (const double x : experiment_.truth.x) {
      const double crest = std::abs(shape(x, 0.0));
      if (!(crest > wall::kLargestRise * half_width)) continue;
      throw InputError(
          "wall",
          fmt::format("the crest at x = {:.4g} mm is {:.4g} um, {:.2g} of the half-width: "
                      "the theory of the wall (moderate rotations) holds up to {:g}",
                      x * 1e3, crest * 1e6, crest / half_width, wall::kLargestRise),
          "Lower levels and flow rates, or make the wall thicker, stiffer or narrower");
    }
  }

  const Scenario& scenario_;
  std::uint64_t seed_;
  const Monitor& monitor_;
  VirtualExperiment& experiment_;
  WallModel model_;
  WallAtRest rest_;
};

}  // namespace

VirtualExperiment make_virtual_experiment(const Scenario& scenario, std::uint64_t seed,
                                          int n_threads, const Monitor& monitor) {
  scenario.validate();
  const std::size_t n_levels = scenario.levels.size(), n_runs = scenario.flow_rates.size();
  const std::size_t n_scenes = n_levels + n_runs;

  VirtualExperiment experiment;
  experiment.header = {experiment_name(scenario, seed), seed, scenario.channel, {}};
  experiment.truth.x = pixel_stations(scenario.channel, scenario.camera);
  experiment.truth.runs.resize(n_runs);
  experiment.scalars.resize(n_runs);
  experiment.truth.levels = read_gauge(scenario, seed);

  std::atomic<std::size_t> n_done{0};
  const auto done = [&] {
    monitor.report("virtual experiment",
                   static_cast<double>(++n_done) / static_cast<double>(2 * n_scenes));
  };
  Walls walls(scenario, seed, monitor, experiment);
  std::vector<Scene> scenes, flow_scenes;
  parallel_for(2, n_threads, [&](Index chain) {
    chain == 0 ? walls.fill(scenes, done) : walls.flow(flow_scenes, done);
  });
  std::move(flow_scenes.begin(), flow_scenes.end(), std::back_inserter(scenes));

  std::vector<std::optional<NamedMap>> maps(n_scenes);
  parallel_for(static_cast<Index>(n_scenes), n_threads, [&](Index i) {
    monitor.checkpoint();
    const auto index = static_cast<std::size_t>(i);
    const Scene& scene = scenes[index];
    maps[index] = NamedMap{scene.name, scene.title,
                           record_map(scenario.channel, scene.shape, scenario.camera, seed, index)};
    done();
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

}  // namespace manoscope::twin
