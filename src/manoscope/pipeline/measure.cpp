#include "manoscope/pipeline/measure.hpp"

#include <fmt/format.h>

#include <atomic>
#include <cmath>
#include <limits>
#include <utility>

#include "manoscope/core/error.hpp"
#include "manoscope/core/options.hpp"
#include "manoscope/core/parallel.hpp"
#include "manoscope/core/provenance.hpp"
#include "manoscope/flow/parasitic.hpp"
#include "manoscope/inversion/end_doubt.hpp"
#include "manoscope/inversion/simultaneous_band.hpp"
#include "manoscope/pipeline/assemble.hpp"
#include "manoscope/pipeline/checks.hpp"
#include "manoscope/pipeline/stages.hpp"
#include "manoscope/pipeline/tube_law_findings.hpp"

namespace manoscope::pipeline {
namespace {

using experiment::Experiment;

flow::Channel channel_of(const Experiment& experiment) {
  return {experiment.channel.length, experiment.channel.width, experiment.channel.height};
}

flow::Fluid fluid_of(const Experiment& experiment) {
  return {experiment.fluid.viscosity, experiment.fluid.density};
}

inversion::GaugeErrors gauge_of(const Experiment& experiment) {
  return {experiment.instrument.pressure_gain_uncertainty.value_or(0.0),
          experiment.instrument.pressure_zero_uncertainty.value_or(Pressure{})};
}

std::optional<Pressure> parasitic_drop(const Experiment& experiment, FlowRate flow_rate) {
  if (!experiment.rigid.inlet && !experiment.rigid.outlet) return std::nullopt;
  Pressure drop{};
  for (const auto& passage : {experiment.rigid.inlet, experiment.rigid.outlet}) {
    if (!passage) continue;
    drop += flow::passage_drop(experiment.fluid.viscosity, flow_rate,
                               {passage->length, passage->width, passage->height});
  }
  return drop;
}

/// Reynolds number and resistance of the measured gap against the reading.
void compare_with_flow(const Experiment& experiment, const FlowRun& run, RunFindings& found) {
  const flow::Channel channel = channel_of(experiment);
  const flow::Fluid fluid = fluid_of(experiment);
  found.reynolds = validation::mean_reynolds(channel, fluid, run.flow_rate, run.profile);
  found.channel_resistance_drop =
      validation::channel_resistance_drop(channel, fluid, run.flow_rate, run.profile).si();
  if (!found.section) return;
  const validation::FlowUncertainty uncertainty{
      experiment.channel.height_uncertainty.value_or(Length{}),
      experiment.fluid.viscosity_uncertainty.value_or(Viscosity{}),
      experiment.instrument.flow_rate_uncertainty.value_or(0.0)};
  found.agreement = validation::compare_drops(channel, fluid, run.flow_rate, uncertainty,
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

std::string reading_text(const std::optional<inversion::NonlocalWall>& wall,
                         const std::string& reason) {
  if (!wall) return "every station on its own: " + reason;
  const wall::ClampedWall& fitted = wall->calibrated.wall;
  return fmt::format(
      "through the influence operator of a clamped wall fitted to the calibration: E = {:.3g} Pa, "
      "prestress {:.3g} Pa, preload {:.3g} Pa, nu = {:.2g}; what it makes of non-uniform pressure "
      "is taken as known to {:.1f} %",
      fitted.youngs_modulus.si(), fitted.prestress.si(), fitted.preload.load.si(),
      fitted.poisson_ratio, 100.0 * wall->calibrated.model_error);
}

/// Names the runs that were read station by station because the steps of the other reading did not
/// settle.
void tell_unsettled(const std::vector<FlowRun>& runs, const std::vector<RunFindings>& findings,
                    results::Measurement& m) {
  std::string names;
  for (std::size_t r = 0; r < runs.size(); ++r) {
    if (!std::isnan(findings[r].half_wavelength)) continue;
    names += (names.empty() ? "" : ", ") + runs[r].name;
  }
  if (names.empty()) return;
  m.reading += "; station by station, since the steps did not settle: " + names;
  m.warnings.push_back(fmt::format(
      "{}: p(x) was read station by station, since reading it through the wall did not settle; "
      "outside the test section it may be off by more than its bars",
      names));
}

RunFindings read_run(const Experiment& experiment, const calibration::ConstitutiveCurves& curves,
                     const std::optional<inversion::NonlocalWall>& wall, double wall_start,
                     const FlowRun& run, const MeasureOptions& options) {
  const flow::Channel channel = channel_of(experiment);
  const inversion::GaugeErrors gauge = gauge_of(experiment);

  RunFindings found;
  found.reading = inversion::read_pressure(curves, run.profile, gauge, options.reading);
  found.stretch = inversion::wanted_stretch(channel.length, channel.width, options.section);
  found.section =
      inversion::find_test_section(found.reading, channel.length, channel.width, options.section);
  inversion::flag_outside(found.reading, found.section);
  found.tube_law = inversion::tube_law_under_flow(curves, run.profile, found.reading, channel,
                                                  fluid_of(experiment), run.flow_rate, wall_start);
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
  found.parasitic_drop = parasitic_drop(experiment, run.flow_rate);
  found.resistance_pressure =
      Array1::Constant(curves.x.size(), std::numeric_limits<double>::quiet_NaN());
  try {
    compare_with_flow(experiment, run, found);
  } catch (const InputError& error) {
    // A gap that closes or exceeds the width ends the comparison, not the reading.
    found.no_comparison = error.found();
  }
  return found;
}

std::string settings_text(const MeasureOptions& options) {
  std::string text;
  for (const OptionInfo& option : list_options(options)) {
    text += fmt::format("{} = {}\n", option.name, option.value);
  }
  return text;
}

std::string place_text(const ChannelFrame& frame) {
  constexpr const char* kFlow[] = {"+columns", "-columns", "+rows", "-rows"};
  return fmt::format(
      "place: origin = ({} m, {} m), flow = {}, across {}, rotation = {} rad, "
      "outward = {}\n",
      frame.origin_x.si(), frame.origin_y.si(), kFlow[static_cast<int>(frame.flow)],
      frame.across_reversed ? "reversed" : "forward", frame.rotation.si(),
      frame.outward == Outward::plus_height ? "+height" : "-height");
}

void store_provenance(const Experiment& experiment, const ReducedExperiment& reduced,
                      const MeasureOptions& options, results::Measurement& m) {
  m.title = title_of(experiment.name);
  m.source = fmt::format("manoscope {} ({})", program_version(), source_revision());
  m.history = "manoscope measure";
  m.experiment = experiment.text;
  m.settings = settings_text(options) + place_text(reduced.frame);
  for (std::size_t i = 0; i < reduced.hash.size(); ++i) {
    const std::size_t n_static = experiment.hydrostatic.size();
    const std::string& name =
        i < n_static ? experiment.hydrostatic[i].name : experiment.flow[i - n_static].name;
    m.inputs += fmt::format("{}  {}\n", name, reduced.hash[i]);
  }
  if (const auto& reference = experiment.instrument.reference) {
    m.inputs += fmt::format("{}  {}\n", reference->filename().string(), reduced.reference_hash);
  }
  m.channel_length = experiment.channel.length.si();
  m.channel_width = experiment.channel.width.si();
  m.channel_height = experiment.channel.height.si();
  m.channel_height_uncertainty = experiment.channel.height_uncertainty.value_or(Length{}).si();
  m.viscosity = experiment.fluid.viscosity.si();
  m.viscosity_uncertainty = experiment.fluid.viscosity_uncertainty.value_or(Viscosity{}).si();
  m.density = experiment.fluid.density.si();
  m.coverage = options.reading.coverage;
}

}  // namespace

std::string title_of(const std::string& experiment_name) {
  return "Pressure inside the micro-channel of " + experiment_name;
}

void MeasureOptions::validate() const {
  reduce.validate();
  curves.validate();
  reading.validate();
  nonlocal.validate();
  section.validate();
  intersections.validate();
}

results::Measurement measure(const Experiment& experiment, const MeasureOptions& options,
                             int n_threads, const Monitor& monitor) {
  options.validate();
  monitor.report("finding the channel", 0.0);
  const maps::FoundPlace place = place_channel(experiment);
  const ReducedExperiment reduced =
      reduce_maps(experiment, place.frame, options.reduce, n_threads, monitor);
  const std::vector<calibration::Level> levels = make_levels(experiment, reduced.hydrostatic);
  calibration::ConstitutiveCurves curves = calibration::fit_curves(levels, options.curves);

  const std::vector<FlowRun> runs = make_runs(experiment, reduced.flow);
  std::string no_wall;
  auto wall =
      runs.empty() ? std::nullopt : find_wall(experiment, curves, options, monitor, no_wall);
  if (wall && options.curves.joint_labels) {
    // The wall says how its curves run between the levels: once more, what each label is worth.
    curves = calibration::fit_curves(levels, options.curves, &wall->uniform);
    inversion::update_offset(*wall, curves);
  }
  const auto at_rest = inversion::tube_law_at_rest(curves, experiment.channel.length,
                                                   experiment.channel.width, gauge_of(experiment));
  std::vector<RunFindings> findings(runs.size());
  std::atomic<int> done{0};
  parallel_for(static_cast<Index>(runs.size()), n_threads, [&](Index r) {
    monitor.checkpoint();
    const auto at = static_cast<std::size_t>(r);
    findings[at] = read_run(experiment, curves, wall, at_rest.start, runs[at], options);
    monitor.report("reading p(x)", static_cast<double>(++done) / static_cast<double>(runs.size()));
  });
  results::Measurement measurement;
  store_provenance(experiment, reduced, options, measurement);
  measurement.reading = reading_text(wall, no_wall);
  store_calibration(curves, experiment, reduced.hydrostatic, measurement);
  store_runs(runs, findings, measurement);
  measurement.flow_rate_uncertainty =
      measurement.flow_rate * experiment.instrument.flow_rate_uncertainty.value_or(0.0);
  store_map_conditions(reduced, measurement);
  store_tube_law(at_rest, inversion::station_stiffness(curves, gauge_of(experiment)), findings,
                 measurement);
  const inversion::Stretch stretch = inversion::wanted_stretch(
      experiment.channel.length, experiment.channel.width, options.section);
  store_left_out(inversion::leave_one_out(curves, options.curves, stretch), measurement);
  store_shapes(experiment, reduced, curves, stretch, n_threads, measurement);
  store_repeats(experiment, reduced, curves, findings, stretch, measurement);
  store_sweeps(levels, options.curves, stretch, measurement);
  measurement.warnings =
      find_doubts(experiment, place, reduced, curves,
                  doubtful_levels(curves, options.curves, stretch), runs, findings);
  for (const auto& doubts : {doubt_shapes(experiment, measurement), doubt_repeats(measurement),
                             doubt_sweeps(measurement)}) {
    measurement.warnings.insert(measurement.warnings.end(), doubts.begin(), doubts.end());
  }
  if (!wall && !runs.empty() && options.nonlocal.nonlocal && experiment.wall &&
      experiment.wall->thickness) {
    measurement.warnings.push_back(fmt::format(
        "every station was read on its own, though wall.thickness is {:.4g} um: {}; check "
        "thickness, length, width and origin. Outside the test section p(x) may be off by more "
        "than its bars",
        experiment.wall->thickness->in(um), no_wall));
  }
  if (wall) tell_unsettled(runs, findings, measurement);
  return measurement;
}

}  // namespace manoscope::pipeline
