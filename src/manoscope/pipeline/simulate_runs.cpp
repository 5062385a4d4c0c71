#include "manoscope/pipeline/simulate_runs.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "manoscope/core/error.hpp"
#include "manoscope/core/provenance.hpp"
#include "manoscope/core/suggest.hpp"
#include "manoscope/flow/laminar.hpp"
#include "manoscope/pipeline/at_stations.hpp"
#include "manoscope/pipeline/store_simulation.hpp"
#include "manoscope/validation/compare_simulation.hpp"

namespace manoscope::pipeline {
namespace {

using experiment::Experiment;
using flow::InletProfile;
using results::Simulation;

const char* profile_name(InletProfile profile) {
  return profile == InletProfile::developed ? "developed" : "uniform";
}

InletProfile other_of(InletProfile profile) {
  return profile == InletProfile::developed ? InletProfile::uniform : InletProfile::developed;
}

/// Which profiles are solved, and how far the truth may lie between them.
struct Inlets {
  InletProfile leading = InletProfile::developed;
  double spread = 0.0;  ///< part of the way to the other profile; 0: it is not solved
  std::string words;
};

Inlets inlets_of(const Experiment& experiment, FlowRate flow_rate, const std::string& option) {
  Inlets inlets;
  inlets.leading = experiment.inlet.profile;
  if (option == "developed" || option == "uniform") {
    inlets.leading = option == "uniform" ? InletProfile::uniform : InletProfile::developed;
    inlets.words = fmt::format("{} where it enters, taken as known", option);
    return inlets;
  }
  inlets.spread = option == "both" ? 1.0 : inlet_spread(experiment, flow_rate);
  const char* const name = profile_name(inlets.leading);
  inlets.words = inlets.spread == 0.0
                     ? fmt::format("{} where it enters, as the experiment says", name)
                     : fmt::format("{} where it enters, or up to {:.0f} % of the way to {}", name,
                                   100.0 * inlets.spread, profile_name(other_of(inlets.leading)));
  return inlets;
}

/// Stations at which the solver is told the smooth wall: a tenth of the height apart, evenly.
Array1 told_stations(const flow::Channel& channel) {
  constexpr double kLeast = 401.0, kMost = 4001.0;
  const double n = std::clamp(10.0 * (channel.length / channel.height), kLeast, kMost);
  return Array1::LinSpaced(static_cast<Index>(n), 0.0, channel.length.si());
}

/// Positions across at which it is told the roof, from the middle to the side, denser there.
Array1 told_across(const flow::Channel& channel) {
  constexpr Index kPositions = 33;
  return 0.5 * channel.width.si() *
         (Array1::LinSpaced(kPositions, 0.0, 1.0) * (0.5 * std::numbers::pi)).sin();
}

std::string roof_words(const validation::SmoothShape& shape) {
  return fmt::format(
      "zeta(x) without ripples shorter than {:.3g} mm (half is left there): {:.2g} nm rms taken "
      "away, stated noise {:.2g} nm",
      shape.half_wavelength().in(mm), shape.taken().in(nm), shape.noise().in(nm));
}

void store_roof(const RunRoof& roof, Simulation& s) {
  s.roof += "; " + roof.words;
  if (!roof.map) return;
  s.roof_map = 1.0;
  s.roof_taken = roof.map->taken().si();
  s.roof_noise = roof.map->noise().si();
  s.roof_end_taken = roof.map->end_taken().si();
  s.roof_misfit = roof.map->misfit();
  s.roof_departure = roof.map->departure().si();
  s.roof_effect = roof.effect->departure;
  s.roof_odd = roof.map->odd().si();
  s.roof_odd_uncertainty = roof.map->odd_standard().si();
  s.roof_odd_effect = roof.effect->odd;
}

/// What one standard deviation of the numerical error does, with the sign in which meshes moved it.
Array1 mesh_effect(const SolvedFlow& solved) {
  const Array1 moved = solved.mean_pressure - solved.coarse_mean_pressure;
  return (moved >= 0.0).select(solved.mean_pressure_uncertainty, -solved.mean_pressure_uncertainty);
}

/// Numerical uncertainty of the drop over the test section, of the channel's where there is none.
double over_section(const SolvedFlow& solved, const RunFindings& found) {
  if (!found.section) return solved.drop_uncertainty;
  const Array1 ends{{found.reading.x[found.section->first], found.reading.x[found.section->last]}};
  const Array1 effect = between(solved.x, mesh_effect(solved), ends);
  return std::abs(effect[0] - effect[1]);
}

/// Indices of the runs that are named, each once.
std::vector<std::size_t> chosen(const Experiment& experiment, const std::vector<FlowRun>& runs,
                                const std::vector<std::string>& names) {
  std::vector<std::string> known;
  for (const FlowRun& run : runs) known.push_back(run.name);
  std::vector<std::size_t> indices;
  const auto take = [&](std::size_t i) {
    if (std::find(indices.begin(), indices.end(), i) == indices.end()) indices.push_back(i);
  };
  for (const std::string& name : names) {
    const auto place = std::find(known.begin(), known.end(), name);
    if (place != known.end()) {
      take(static_cast<std::size_t>(place - known.begin()));
    } else if (name == "all") {
      for (std::size_t i = 0; i < known.size(); ++i) take(i);
    } else {
      throw InputError(
          "--run",
          fmt::format("\"{}\" is no run of {}{}", name, experiment.name, did_you_mean(name, known)),
          fmt::format("Choose from {}, or all", fmt::join(known, ", ")));
    }
  }
  return indices;
}

}  // namespace

ReadyRuns ready_runs(const Experiment& experiment, const std::vector<std::string>& names,
                     const MeasureOptions& options, int n_threads, const Monitor& monitor) {
  options.validate();
  if (experiment.flow.empty()) {
    throw InputError(experiment.file.string(), "holds no flow runs, only hydrostatic maps",
                     "List the maps under flow in [flow]; a shape of your own goes to --shape");
  }
  if (names.empty()) {
    throw InputError("--run", "is not given", "Name a run, as --run Q70, or --run all");
  }
  ReadyRuns ready;
  ready.calibration = calibrate(experiment, options, n_threads, monitor);
  ready.inputs = inputs_text(experiment, ready.calibration.reduced);
  std::vector<FlowRun> runs;
  for (const std::size_t i : chosen(experiment, ready.calibration.runs, names)) {
    const FlowRun& run = ready.calibration.runs[i];
    if (!(run.flow_rate > FlowRate{})) {
      throw InputError(run.name, fmt::format("flows at {:g} mL/min", run.flow_rate.in(mL_per_min)),
                       "A simulation needs a positive flow rate, with x along the flow");
    }
    runs.push_back(run);
  }
  ready.calibration.runs = std::move(runs);
  ready.flow = know_flow(experiment, ready.calibration.reduced, ready.calibration.curves,
                         ready.calibration.runs, options.flow.flow_stations,
                         validation::PredictFlowOptions{}.largest_extrapolation);
  ready.findings =
      read_runs(experiment, ready.calibration, std::nullopt, options, n_threads, monitor);
  return ready;
}

Simulation simulate_run(const Experiment& experiment, const ReadyRuns& ready, std::size_t which,
                        const SimulateOptions& options, const FlowSolver& solver,
                        const Monitor& monitor) {
  const FlowRun& run = ready.calibration.runs[which];
  const RunFindings& found = ready.findings[which];
  const flow::Channel channel = channel_of(experiment);
  const validation::SmoothShape shape(run.profile, channel);
  const Inlets inlets = inlets_of(experiment, run.flow_rate, options.inlet);

  GivenFlow given{options.dim,
                  channel,
                  fluid_of(experiment),
                  run.flow_rate,
                  told_stations(channel),
                  {},
                  ready.flow.setup.shape,
                  inlets.leading,
                  true};
  given.zeta = shape.zeta(given.x);
  RunRoof roof;
  if (options.dim == 3) roof = roof_of_run(run, shape, ready.flow, options.roof);
  if (roof.map) {
    given.z = told_across(channel);
    given.roof = roof.map->even(given.x, given.z);
    validation::require_open_gap(given.x, given.z, given.roof, channel.height);
  }
  const auto solve = [&](InletProfile profile, bool leading) {
    monitor.checkpoint();
    monitor.report(fmt::format("{}: Navier-Stokes, {} inlet", run.name, profile_name(profile)),
                   leading ? 0.0 : 0.5);
    given.inlet = profile;
    given.leading = leading;
    return solver(given);
  };
  const SolvedFlow solved = solve(inlets.leading, true);

  Simulation s;
  s.run = run.name;
  s.source = fmt::format("manoscope {} ({})", program_version(), source_revision());
  s.experiment = experiment.text;
  s.inputs = ready.inputs;
  s.inlet = inlets.words;
  s.roof = roof_words(shape);
  if (options.dim == 3) store_roof(roof, s);
  s.dim = options.dim;
  s.flow_rate = run.flow_rate.si();
  s.smoothing_half_wavelength = shape.half_wavelength().si();
  s.smoothing_taken = shape.taken().si();
  s.smoothing_noise = shape.noise().si();
  s.longest_silence = shape.longest_silence().si();
  const validation::Outlet outlet =
      outlet_of(experiment, ready.flow, run, found.reading, found.section);
  s.outlet_pressure = outlet.pressure.si();
  s.outlet_uncertainty = outlet.uncertainty.si();
  store_solution(solved, outlet.pressure.si(), s);
  s.zeta = shape.zeta(s.x);
  s.zeta_uncertainty = shape.standard(s.x);
  s.inlet_effect = Array1::Zero(s.x.size());
  if (inlets.spread > 0.0) {
    const SolvedFlow other = solve(other_of(inlets.leading), false);
    s.inlet_effect = inlets.spread * (other.mean_pressure - solved.mean_pressure);
    // Of the other flow a part of the way is taken, and as much of its error where it counts. (At a
    // sharp edge, x = 0, a uniform flow's pressure is not finite and depends on any mesh.)
    const double numerical = inlets.spread * over_section(other, found);
    if (numerical > options.tolerance * std::abs(solved.drop)) s.converged = 0.0;
    s.seconds += other.seconds;
    s.peak_memory = std::max(s.peak_memory, other.peak_memory);
  }
  // About the end of a rectangular distribution the mean square is a third of its width squared.
  validation::SolvedPressure pressure{solved.x, solved.mean_pressure, mesh_effect(solved),
                                      s.inlet_effect / std::numbers::sqrt3, options.dim == 2};
  if (roof.map) {
    pressure.roof_across = between(roof.effect->x, roof.effect->pressure_error, solved.x);
  }
  const validation::SimulationComparison comparison =
      validation::compare_simulation(ready.flow.setup, run.flow_rate, shape, run.profile, pressure,
                                     outlet, found.reading, found.section);
  store_comparison(comparison, s);
  store_reading(found, s);
  if (found.agreement) {
    // The figure that result.nc holds of the same reading, to the last bit.
    s.extracted_drop = found.agreement->extracted.value;
    s.extracted_drop_uncertainty = found.agreement->extracted.standard_uncertainty();
  }
  return s;
}

std::vector<std::string> simulation_doubts(const Simulation& s, const Experiment& experiment) {
  std::vector<std::string> doubts;
  if (s.converged == 0.0) {
    doubts.push_back(fmt::format(
        "{}: the drop of the channel ({:.2g} % uncertain as solved), or what the inlet does to "
        "that "
        "of the test section, has not converged for want of cells: take more (--cells-along, "
        "--cells-up)",
        s.run, 100.0 * s.channel_drop_numerical_uncertainty / std::abs(s.channel_drop)));
  }
  const double reynolds = flow::duct_reynolds(channel_of(experiment), fluid_of(experiment),
                                              FlowRate::from_si(s.flow_rate));
  if (reynolds > flow::kLargestLaminarReynolds) {
    doubts.push_back(
        fmt::format("{}: Re = {:.0f} on the hydraulic diameter, where ducts may turn turbulent: a "
                    "steady laminar "
                    "flow was solved",
                    s.run, reynolds));
  }
  constexpr double kRough = 1.5;
  if (s.smoothing_taken > kRough * s.smoothing_noise) {
    doubts.push_back(fmt::format(
        "{}: smoothing took {:.2g} nm rms away, {:.1f} times the stated noise: the profile holds "
        "ripples shorter than two heights, and the simulation does not see them",
        s.run, s.smoothing_taken * 1e9, s.smoothing_taken / s.smoothing_noise));
  }
  if (s.roof_map != 0.0 && s.roof_misfit > kRough) {
    doubts.push_back(fmt::format(
        "{}: {:.2g} nm rms of the shape across are no smooth departure from the shape between the "
        "levels, {:.1f} times the stated noise: the roof does not hold them",
        s.run, s.roof_taken * 1e9, s.roof_misfit));
  }
  constexpr double kSigmas = 4.0, kFelt = 5e-4;  // of the drop
  if (s.roof_map != 0.0 && s.roof_odd > kSigmas * s.roof_odd_uncertainty &&
      std::abs(s.roof_odd_effect) > kFelt) {
    doubts.push_back(fmt::format(
        "{}: the wall is not symmetric across, by {:.2g} um rms; half the channel is solved, and "
        "what is odd, {:+.1g} % of the drop, is left out",
        s.run, s.roof_odd * 1e6, 100.0 * s.roof_odd_effect));
  }
  if (s.longest_silence > experiment.channel.width.si()) {
    doubts.push_back(
        fmt::format("{}: {:.2g} mm of the wall were not measured and are bridged by a smooth curve",
                    s.run, s.longest_silence * 1e3));
  }
  return doubts;
}

}  // namespace manoscope::pipeline
