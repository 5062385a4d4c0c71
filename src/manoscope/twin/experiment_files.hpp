#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "manoscope/core/monitor.hpp"
#include "manoscope/core/units.hpp"
#include "manoscope/twin/scenario.hpp"
#include "manoscope/twin/virtual_experiment.hpp"

namespace manoscope::twin {

/// Name of a run: "Q5", "Q12.5", the number being mL/min.
std::string run_label(FlowRate flow_rate);

/// Name of the experiment made of a scenario: "S1 (virtual), seed 7".
std::string experiment_name(const Scenario& scenario, std::uint64_t seed);
/// The experiment.toml a user of this scenario would write; every value with its unit, those of
/// wall and instrument in the unit in which the number lies in [1, 1000).
/// @param name  of the experiment.
/// @param stated_height  the gap 2 h0 as the user knows it.
std::string experiment_toml(const Scenario& scenario, const std::string& name,
                            Length stated_height);
/// Its list of calibration maps, in the scenario's order.
std::string hydrostatic_csv(const Scenario& scenario, const std::vector<LevelTruth>& levels);
/// Its list of flow maps, f00.gsf and on.
std::string flow_csv(const std::vector<RunScalars>& runs);

/// Sees that an experiment may be written to a folder, before the work of making it. Leaves
/// nothing behind.
/// @throws InputError if it holds an experiment.toml and `overwrite` is false, or if it cannot be
///         made or written.
void check_destination(const std::filesystem::path& folder, bool overwrite = false);

/// Writes a virtual experiment as a folder that can be measured, its truth in the folder `truth`.
///
/// Maps (.gsf), hydrostatic.csv, flow.csv, truth/truth.nc, truth/truth.csv,
/// truth/truth_scalars.csv, truth/truth_levels.csv, truth/truth_static.csv. All is written apart
/// (`.manoscope-twin` in the folder) and then moved into place, experiment.toml last: a folder that
/// holds one is complete, and a run that fails or is stopped before leaves the folder as it was.
///
/// @param overwrite  replace an experiment that stands there already.
/// @param monitor    asked before each map.
/// @throws InputError if `folder` holds an experiment.toml and `overwrite` is false, or if it
///         cannot be made or written.
/// @throws Interrupted if the monitor says so.
void write_experiment(const std::filesystem::path& folder, const VirtualExperiment& experiment,
                      bool overwrite = false, const Monitor& monitor = {});

}  // namespace manoscope::twin
