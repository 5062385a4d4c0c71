#pragma once

#include <optional>
#include <string>
#include <vector>

#include "manoscope/inversion/read_nonlocal.hpp"
#include "manoscope/pipeline/assemble.hpp"
#include "manoscope/pipeline/measure_options.hpp"

namespace manoscope::pipeline {

/// What the maps of an experiment give before any run is read.
struct Calibration {
  maps::FoundPlace place;
  ReducedExperiment reduced;
  std::vector<calibration::Level> levels;
  calibration::ConstitutiveCurves curves;
  std::vector<FlowRun> runs;
  std::optional<inversion::NonlocalWall> wall;  ///< fitted to the curves; none: why in no_wall
  std::string no_wall;
  inversion::TubeLawAtRest at_rest;
};

/// Finds the channel, reads and reduces every map, fits the constitutive curves, and the wall that
/// the experiment tells of to them.
/// @throws InputError for maps that cannot be used; Interrupted when the monitor asks to stop.
Calibration calibrate(const experiment::Experiment& experiment, const MeasureOptions& options,
                      int n_threads, const Monitor& monitor);

/// sqrt(-b/a) of the fitted wall, at mid-channel under the middle level; none without one.
std::optional<Length> healing_length(const Calibration& calibration);

/// The flow as models see it; none where they are switched off or, with a reason, cannot be run.
std::optional<FlowKnowledge> find_flow(const experiment::Experiment& experiment,
                                       const Calibration& calibration,
                                       const MeasureOptions& options, std::string& reason);

/// Reads p(x) of every run, finds its test section, and compares it with the flow.
/// @param flow  none if flow models are not run.
std::vector<RunFindings> read_runs(const experiment::Experiment& experiment,
                                   const Calibration& calibration,
                                   const std::optional<FlowKnowledge>& flow,
                                   const MeasureOptions& options, int n_threads,
                                   const Monitor& monitor);

}  // namespace manoscope::pipeline
