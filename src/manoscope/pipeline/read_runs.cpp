#include "manoscope/pipeline/read_runs.hpp"

#include <fmt/format.h>

#include <atomic>
#include <limits>
#include <numbers>
#include <utility>

#include "manoscope/core/error.hpp"
#include "manoscope/core/parallel.hpp"
#include "manoscope/inversion/end_doubt.hpp"
#include "manoscope/inversion/simultaneous_band.hpp"

namespace manoscope::pipeline {
namespace {

using experiment::Experiment;

/// Reynolds number and resistance of the measured gap against the reading.
void compare_with_flow(const Experiment& experiment, const FlowRun& run, RunFindings& found) {
  const flow::Channel channel = channel_of(experiment);
  const flow::Fluid fluid = fluid_of(experiment);
  found.reynolds = validation::mean_reynolds(channel, fluid, run.flow_rate, run.profile);
  found.channel_resistance_drop =
      validation::channel_resistance_drop(channel, fluid, run.flow_rate, run.profile).si();
  if (!found.section) return;
  found.agreement =
      validation::compare_drops(channel, fluid, run.flow_rate, flow_uncertainty_of(experiment),
                                run.profile, found.reading, *found.section);
  found.resistance_pressure = validation::resistance_pressure(
      channel, fluid, run.flow_rate, run.profile, found.reading, *found.section);
}

/// The wall that the experiment tells of, fitted to the calibration; none, with a reason, where it
/// tells of none or no clamped wall answers as the calibration did.
std::optional<inversion::NonlocalWall> find_wall(const Experiment& experiment,
                                                 const calibration::ConstitutiveCurves& curves,
                                                 const MeasureOptions& options,
                                                 const Monitor& monitor, std::string& reason) {
  if (!options.nonlocal.nonlocal) {
    reason = "switched off";
    return std::nullopt;
  }
  if (!experiment.wall || !experiment.wall->thickness) {
    reason = "the experiment does not tell wall.thickness";
    return std::nullopt;
  }
  monitor.report("solving the wall", 0.0);
  const inversion::WallKnowledge known{experiment.channel.length, experiment.channel.width,
                                       *experiment.wall->thickness, experiment.wall->poisson_ratio};
  return inversion::make_nonlocal_wall(curves, known, options.nonlocal, monitor, reason);
}

RunFindings read_run(const Experiment& experiment, const Calibration& calibration,
                     const std::optional<FlowKnowledge>& flow, const FlowRun& run,
                     const MeasureOptions& options) {
  const calibration::ConstitutiveCurves& curves = calibration.curves;
  const auto& wall = calibration.wall;
  const flow::Channel channel = channel_of(experiment);
  const inversion::GaugeErrors gauge = gauge_of(experiment);

  RunFindings found;
  found.reading = inversion::read_pressure(curves, run.profile, gauge, options.reading);
  found.stretch = inversion::wanted_stretch(channel.length, channel.width, options.section);
  found.section =
      inversion::find_test_section(found.reading, channel.length, channel.width, options.section);
  inversion::flag_outside(found.reading, found.section);
  found.tube_law = inversion::tube_law_under_flow(curves, run.profile, found.reading, channel,
                                                  fluid_of(experiment), run.flow_rate,
                                                  calibration.at_rest.start);
  std::optional<inversion::NonlocalReading> nonlocal;
  if (wall) {
    nonlocal =
        inversion::read_nonlocal(found.reading, *wall, options.reading.coverage, options.nonlocal);
  }
  if (found.section) {
    inversion::add_end_doubt(found.reading, *found.section, channel.length, channel.width,
                             options.reading.coverage);
  }
  found.local_pressure = found.reading.pressure;
  found.local_uncertainty = found.reading.uncertainty.standard();
  if (nonlocal) {
    found.reading = std::move(nonlocal->pressure);
    found.half_wavelength = nonlocal->half_wavelength;
  }
  found.band_factor = inversion::simultaneous_factor(found.reading, options.reading.coverage);
  found.intersections = inversion::find_intersections(curves.estimated_levels(), run.profile,
                                                      channel.width, options.intersections);
  if (found.section) {
    // At the clamped ends every profile meets every other: no reading (Ozsun et al. 2013, sec. III
    // C).
    std::erase_if(found.intersections, [&](const inversion::Intersection& crossing) {
      return crossing.x.si() < found.reading.x[found.section->first] ||
             crossing.x.si() > found.reading.x[found.section->last];
    });
  }
  found.resistance_pressure =
      Array1::Constant(curves.x.size(), std::numeric_limits<double>::quiet_NaN());
  try {
    compare_with_flow(experiment, run, found);
  } catch (const InputError& error) {
    // A gap that closes or exceeds the width ends the comparison, not the reading.
    found.no_comparison = error.found();
  }
  found.flow = compare_flow(experiment, flow, run, found.reading, found.section, options.flow);
  return found;
}

}  // namespace

Calibration calibrate(const Experiment& experiment, const MeasureOptions& options, int n_threads,
                      const Monitor& monitor) {
  monitor.report("finding the channel", 0.0);
  Calibration found;
  found.place = place_channel(experiment);
  found.reduced = reduce_maps(experiment, found.place.frame, options.reduce, n_threads, monitor);
  found.levels = make_levels(experiment, found.reduced.hydrostatic);
  found.curves = calibration::fit_curves(found.levels, options.curves);
  found.runs = make_runs(experiment, found.reduced.flow);
  if (!found.runs.empty()) {
    found.wall = find_wall(experiment, found.curves, options, monitor, found.no_wall);
  }
  if (found.wall && options.curves.joint_labels) {
    // The wall says how its curves run between the levels: once more, what each label is worth.
    found.curves = calibration::fit_curves(found.levels, options.curves, &found.wall->uniform);
    inversion::update_offset(*found.wall, found.curves);
  }
  found.at_rest = inversion::tube_law_at_rest(found.curves, experiment.channel.length,
                                              experiment.channel.width, gauge_of(experiment));
  return found;
}

std::optional<Length> healing_length(const Calibration& calibration) {
  // A ripple of which half is left: (2 pi L/lambda)^2 = 1.
  if (!calibration.wall || !(calibration.wall->half_wavelength > 0.0)) return std::nullopt;
  return Length::from_si(calibration.wall->half_wavelength / (2.0 * std::numbers::pi));
}

std::optional<FlowKnowledge> find_flow(const Experiment& experiment, const Calibration& calibration,
                                       const MeasureOptions& options, std::string& reason) {
  if (calibration.runs.empty() || !options.flow.flow_models) return std::nullopt;
  try {
    FlowKnowledge known = know_flow(experiment, calibration.reduced, calibration.curves,
                                    calibration.runs, options.flow.flow_stations,
                                    validation::PredictFlowOptions{}.largest_extrapolation);
    known.healing_length = healing_length(calibration);
    return known;
  } catch (const InputError& error) {
    reason = fmt::format("{} {}", error.where(), error.found());
    return std::nullopt;
  }
}

std::vector<RunFindings> read_runs(const Experiment& experiment, const Calibration& calibration,
                                   const std::optional<FlowKnowledge>& flow,
                                   const MeasureOptions& options, int n_threads,
                                   const Monitor& monitor) {
  std::vector<RunFindings> findings(calibration.runs.size());
  std::atomic<int> done{0};
  parallel_for(static_cast<Index>(findings.size()), n_threads, [&](Index r) {
    monitor.checkpoint();
    const auto at = static_cast<std::size_t>(r);
    findings[at] = read_run(experiment, calibration, flow, calibration.runs[at], options);
    monitor.report("reading p(x)",
                   static_cast<double>(++done) / static_cast<double>(findings.size()));
  });
  return findings;
}

}  // namespace manoscope::pipeline
