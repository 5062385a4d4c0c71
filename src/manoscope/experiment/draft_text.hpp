#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "manoscope/core/grid.hpp"
#include "manoscope/experiment/file_name_guess.hpp"

namespace manoscope::experiment {

/// A map and what its name says.
struct GuessedMap {
  std::string name;
  FileNameGuess guess;
};

/// The text of a drafted experiment.toml.
///
/// @param name        The experiment's; "" leaves the key out.
/// @param grid        Of one map, nullopt if none could be read.
/// @param grid_map    The name of that map.
/// @param with_flow   Whether there is a flow.csv.
/// @param unassigned  Maps in neither list, told in a comment.
std::string draft_toml(const std::string& name, const std::optional<CameraGrid>& grid,
                       const std::string& grid_map, bool with_flow,
                       const std::vector<std::string>& unassigned);

/// The text of hydrostatic.csv: each guess is told in a comment above the table, "?" stands for a
/// level that the name does not tell.
std::string draft_hydrostatic(const std::vector<GuessedMap>& maps);

/// The text of flow.csv; maps of one flow rate share a run, named after it.
std::string draft_flow(const std::vector<GuessedMap>& maps);

/// True if a name survives the way through a list or an experiment file unchanged.
bool can_be_listed(const std::string& name);
bool can_be_a_name(const std::string& name);

}  // namespace manoscope::experiment
