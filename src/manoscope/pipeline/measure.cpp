#include "manoscope/pipeline/measure.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <utility>

#include "manoscope/core/error.hpp"
#include "manoscope/core/frame_words.hpp"
#include "manoscope/core/options.hpp"
#include "manoscope/core/parallel.hpp"
#include "manoscope/core/provenance.hpp"
#include "manoscope/pipeline/assemble.hpp"
#include "manoscope/pipeline/checks.hpp"
#include "manoscope/pipeline/read_runs.hpp"
#include "manoscope/pipeline/stages.hpp"
#include "manoscope/pipeline/tube_law_findings.hpp"

namespace manoscope::pipeline {
namespace {

using experiment::Experiment;

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

/// Tells what could not be done with the flow models, run by run.
void tell_flow_failures(const std::vector<FlowRun>& runs, const std::vector<RunFindings>& findings,
                        results::Measurement& m) {
  for (std::size_t r = 0; r < runs.size(); ++r) {
    for (const std::string& failure : findings[r].flow.failures) {
      m.warnings.push_back(fmt::format("Run {}: no {}", runs[r].name, failure));
    }
  }
}

std::string settings_text(const MeasureOptions& options) {
  std::string text;
  for (const OptionInfo& option : list_options(options)) {
    text += fmt::format("{} = {}\n", option.name, option.value);
  }
  return text;
}

std::string place_text(const ChannelFrame& frame) {
  return fmt::format(
      "place: origin = ({} m, {} m), flow = {}, across {}, rotation = {} rad, "
      "outward = {}\n",
      frame.origin_x.si(), frame.origin_y.si(), word_of(kFlowDirections, frame.flow),
      frame.across_reversed ? "reversed" : "forward", frame.rotation.si(),
      word_of(kOutwards, frame.outward));
}

void store_provenance(const Experiment& experiment, const ReducedExperiment& reduced,
                      const MeasureOptions& options, results::Measurement& m) {
  m.title = title_of(experiment.name);
  m.source = fmt::format("manoscope {} ({})", program_version(), source_revision());
  m.history = "manoscope measure";
  m.experiment = experiment.text;
  m.settings = settings_text(options) + place_text(reduced.frame);
  m.inputs = inputs_text(experiment, reduced);
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

results::Measurement measure(const Experiment& experiment, const MeasureOptions& options,
                             int n_threads, const Monitor& monitor) {
  options.validate();
  const Calibration calibration = calibrate(experiment, options, n_threads, monitor);
  const auto& [place, reduced, levels, curves, runs, wall, no_wall, at_rest] = calibration;
  std::string no_flow;
  const auto flow = find_flow(experiment, calibration, options, no_flow);
  std::vector<RunFindings> findings =
      read_runs(experiment, calibration, flow, options, n_threads, monitor);
  const ChosenModel chosen = choose_model(findings, options.flow);
  if (flow) {
    parallel_for(static_cast<Index>(findings.size()), n_threads, [&](Index r) {
      monitor.checkpoint();
      RunFindings& found = findings[static_cast<std::size_t>(r)];
      apply_model(experiment, *flow, chosen.model, calibration.runs[static_cast<std::size_t>(r)],
                  found.reading, found.section, options.flow, found.flow);
    });
  }
  monitor.report("checking without truth", 0.0);
  results::Measurement measurement;
  store_provenance(experiment, reduced, options, measurement);
  measurement.reading = reading_text(wall, no_wall);
  store_calibration(curves, experiment, reduced.hydrostatic, measurement);
  store_runs(runs, findings, measurement);
  store_flow(flow, chosen, runs, findings, measurement);
  measurement.flow_rate_uncertainty =
      measurement.flow_rate * experiment.instrument.flow_rate_uncertainty.value_or(0.0);
  store_map_conditions(experiment, reduced, measurement);
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
  if (!no_flow.empty()) {
    measurement.warnings.push_back("the flow models were not run: " + no_flow);
  }
  tell_flow_failures(runs, findings, measurement);
  return measurement;
}

}  // namespace manoscope::pipeline
