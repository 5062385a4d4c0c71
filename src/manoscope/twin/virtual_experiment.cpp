#include "manoscope/twin/virtual_experiment.hpp"

#include <fmt/format.h>

#include <atomic>
#include <optional>
#include <utility>

#include "manoscope/core/error.hpp"
#include "manoscope/core/parallel.hpp"
#include "manoscope/core/random.hpp"
#include "manoscope/flow/channel_resistance.hpp"
#include "manoscope/twin/experiment_files.hpp"

namespace manoscope::twin {
namespace {

std::size_t at(Index i) { return static_cast<std::size_t>(i); }

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
  const Array1 x = Array1::LinSpaced(zeta.size(), 0.0, scenario.channel.length.si());
  run.reynolds = flow::channel_reynolds(scenario.channel, scenario.fluid, flow_rate, x, zeta);
  return run;
}

/// The wall at rest under a uniform pressure, at the nodes solve_coupled() would use.
/// @throws InputError if it touches the floor.
UniformCurve static_deflection(const Scenario& scenario, const wall::TaperedMembrane& wall,
                               Pressure pressure) {
  return solve_coupled(scenario.channel, scenario.fluid, wall, FlowRate{}, pressure,
                       scenario.solver)
      .deflection;
}

}  // namespace

VirtualExperiment make_virtual_experiment(const Scenario& scenario, std::uint64_t seed,
                                          int n_threads, const Monitor& monitor) {
  scenario.validate();
  const wall::TaperedMembrane wall = scenario.make_wall();
  const auto n_levels = static_cast<Index>(scenario.levels.size());
  const auto n_runs = static_cast<Index>(scenario.flow_rates.size());

  VirtualExperiment experiment;
  experiment.height = scenario.channel.height;
  experiment.truth.x = pixel_stations(scenario.channel, scenario.camera);
  experiment.truth.runs.resize(at(n_runs));
  experiment.scalars.resize(at(n_runs));
  experiment.levels = read_gauge(scenario, seed);

  std::vector<std::optional<NamedMap>> maps(at(n_levels + n_runs));
  std::atomic<Index> n_done{0};
  parallel_for(n_levels + n_runs, n_threads, [&](Index i) {
    monitor.checkpoint();
    std::optional<UniformCurve> deflection;
    std::string name, title;
    if (i < n_levels) {
      LevelTruth& level = experiment.levels[at(i)];
      deflection = static_deflection(scenario, wall, level.pressure);
      level.deflection = (*deflection)(experiment.truth.x);
      name = level.map;
      title = fmt::format("{} hydrostatic {:g} Pa", scenario.name, level.pressure.si());
    } else {
      const Index run = i - n_levels;
      const FlowRate flow_rate = scenario.flow_rates[at(run)];
      const CoupledFlow flow = solve_coupled(scenario.channel, scenario.fluid, wall, flow_rate,
                                             scenario.outlet.pressure(flow_rate), scenario.solver);
      deflection = flow.deflection;
      experiment.truth.runs[at(run)] = {run_label(flow_rate), flow.pressure(experiment.truth.x),
                                        flow.deflection(experiment.truth.x)};
      const double noise =
          RandomStream(seed, "transducer noise", static_cast<std::uint64_t>(run)).normal();
      experiment.scalars[at(run)] = run_scalars(scenario, flow_rate, flow, noise);
      name = fmt::format("f{:02d}.gsf", run);
      title = fmt::format("{} flow {:g} mL/min", scenario.name, flow_rate.in(mL_per_min));
    }
    maps[at(i)] = NamedMap{name, title,
                           record_map(scenario.channel, *deflection, scenario.camera, seed,
                                      static_cast<std::uint64_t>(i))};
    monitor.report("virtual experiment",
                   static_cast<double>(++n_done) / static_cast<double>(n_levels + n_runs));
  });
  for (std::optional<NamedMap>& map : maps) experiment.maps.push_back(*std::move(map));

  const double height_error = RandomStream(seed, "stated height").normal();
  experiment.experiment_toml = experiment_toml(
      scenario, scenario.channel.height + height_error * scenario.height_uncertainty);
  experiment.hydrostatic_csv = hydrostatic_csv(scenario, experiment.levels);
  experiment.flow_csv = flow_csv(experiment.scalars);
  return experiment;
}

}  // namespace manoscope::twin
