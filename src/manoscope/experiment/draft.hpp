#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace manoscope::experiment {

/// What draft_experiment() wrote, and what it could not place.
struct Draft {
  std::vector<std::filesystem::path> written;  ///< experiment.toml and the lists
  std::vector<std::string> hydrostatic, flow;  ///< names of the maps in each list, in their order
  /// Maps in neither list: nothing in the name tells which, or two values contradict each other.
  std::vector<std::string> unassigned;
  std::vector<std::string> no_maps;  ///< files that no reader knows; left alone
};

/// Writes a first experiment.toml, hydrostatic.csv and flow.csv from the maps in a folder.
///
/// Sizes are read from one map; pressures and flow rates are guessed from the file names
/// (guess_from_file_name) and every guess is marked with a comment `# CONFIRM`. What only the user
/// can know (the channel's sizes, a level that no name tells) stands there as "?", which
/// read_experiment() then reports by line and key. flow.csv is left out if no map is one under
/// flow.
///
/// Folders below `folder` and hidden files are not looked at.
///
/// @throws InputError if the folder is not there, holds no map, already holds one of the files
///         (nothing is ever overwritten), or cannot be written to.
Draft draft_experiment(const std::filesystem::path& folder);

}  // namespace manoscope::experiment
