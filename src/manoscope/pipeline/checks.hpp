#pragma once

#include <string>
#include <vector>

#include "manoscope/inversion/leave_one_out.hpp"
#include "manoscope/pipeline/assemble.hpp"

namespace manoscope::pipeline {

// What a measurement tells of its own trustworthiness without knowing the truth. Each check fills
// its part of results::Checks; doubts in words come from there.

void store_left_out(const inversion::LeftOut& left_out, results::Measurement& measurement);

/// Cross-sections of every map against the shapes that the levels give the wall. Of runs within
/// their test section, of levels within `stretch`.
void store_shapes(const experiment::Experiment& experiment, const ReducedExperiment& reduced,
                  const calibration::ConstitutiveCurves& curves, const inversion::Stretch& stretch,
                  int n_threads, results::Measurement& measurement);

/// Maps whose misfit is no chance (once in 10^4) and could shift p by more than two of its standard
/// uncertainties.
std::vector<std::string> doubt_shapes(const experiment::Experiment& experiment,
                                      const results::Measurement& measurement);

/// Levels and flow rates of which there is more than one map.
void store_repeats(const experiment::Experiment& experiment, const ReducedExperiment& reduced,
                   const calibration::ConstitutiveCurves& curves,
                   const std::vector<RunFindings>& findings, const inversion::Stretch& stretch,
                   results::Measurement& measurement);

/// Levels on the way down against those on the way up, if the list goes both ways.
/// @param levels  in the order of the list.
void store_sweeps(const std::vector<calibration::Level>& levels,
                  const calibration::FitCurvesOptions& options, const inversion::Stretch& stretch,
                  results::Measurement& measurement);

/// A difference between both ways beyond chance (once in 10^3).
std::vector<std::string> doubt_sweeps(const results::Measurement& measurement);

/// Repeats that scatter by more than their bars, beyond chance (once in 10^3).
std::vector<std::string> doubt_repeats(const results::Measurement& measurement);

}  // namespace manoscope::pipeline
