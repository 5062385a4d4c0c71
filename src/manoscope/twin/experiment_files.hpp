#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "manoscope/core/units.hpp"
#include "manoscope/twin/scenario.hpp"
#include "manoscope/twin/virtual_experiment.hpp"

namespace manoscope::twin {

/// Name of a run: "Q5", "Q12.5", the number being mL/min.
std::string run_label(FlowRate flow_rate);

/// The experiment.toml a user of this scenario would write; every value with its unit.
/// @param stated_height  the gap 2 h0 as the user knows it.
std::string experiment_toml(const Scenario& scenario, Length stated_height);
/// Its list of calibration maps, in the scenario's order.
std::string hydrostatic_csv(const Scenario& scenario, const std::vector<LevelTruth>& levels);
/// Its list of flow maps, f00.gsf and on.
std::string flow_csv(const std::vector<RunScalars>& runs);

/// Writes a virtual experiment as a folder that can be measured, its truth in the folder `truth`.
///
/// Maps (.gsf), hydrostatic.csv, flow.csv, truth/truth.csv, truth/truth_scalars.csv,
/// truth/truth_levels.csv, truth/truth_static.csv; experiment.toml comes last, so that a folder
/// that holds one is complete. Each file appears whole or not at all.
///
/// @param overwrite  replace an experiment that stands there already.
/// @throws InputError if `folder` holds an experiment.toml and `overwrite` is false, or if it
/// cannot
///         be made or written.
void write_experiment(const std::filesystem::path& folder, const VirtualExperiment& experiment,
                      bool overwrite = false);

}  // namespace manoscope::twin
