#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "manoscope/results/measurement.hpp"
#include "manoscope/results/simulation.hpp"

namespace manoscope::results {

/// Where the simulation of a run stands in a result folder: "simulation/<run>_2d.nc", characters
/// that not every file system takes as their code, "%2F".
std::filesystem::path simulation_file(const std::string& run, int dim);

/// Writes a simulation into the folder of its result: it takes the place of an earlier one of the
/// same run and number of dimensions, and touches no other file. A run killed meanwhile leaves the
/// earlier one.
/// @return the file.
/// @throws InputError naming what cannot be written.
std::filesystem::path write_simulation(const std::filesystem::path& folder,
                                       const Simulation& simulation);

/// Reads one file of write_simulation().
/// @throws InputError naming the file if it is none, or damaged.
Simulation read_simulation(const std::filesystem::path& file);

/// The simulations beside a result, by run and dimensions.
struct StoredSimulations {
  std::vector<Simulation> simulations;
  std::vector<std::string> left_out;  ///< those of other maps or another reading, in words
};

/// Those that belong to this measurement: made of the same maps and the same experiment file, and
/// held against the same reading. Empty where there is no folder "simulation".
/// @throws InputError as read_simulation().
StoredSimulations read_simulations(const std::filesystem::path& folder,
                                   const Measurement& measurement);

/// Looks whether a result stands in `folder` that simulations of these maps belong to.
/// @throws InputError if there is none, or it is of another experiment or other maps.
void check_result_of(const std::filesystem::path& folder, const std::string& experiment,
                     const std::string& inputs);

/// The same for what does not depend on the maps.
void check_result_of(const std::filesystem::path& folder, const std::string& experiment);

/// Keeps a table of the drops of the rigid passages (pipeline::passages_table()) beside a result,
/// in simulation/passages.csv.
/// @return the file.
/// @throws InputError naming what cannot be written.
std::filesystem::path write_passages(const std::filesystem::path& folder, const std::string& table);

}  // namespace manoscope::results
