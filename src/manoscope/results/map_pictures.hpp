#pragma once

#include <filesystem>
#include <vector>

#include "manoscope/results/measurement.hpp"

namespace manoscope::results {

/// Writes the pictures of a measurement's maps as NetCDF-4: deflection_counts (map, z, x) in
/// multiples of step (map). The bytes depend on the pictures alone.
///
/// @param shown_as  the name that messages use, where the file is renamed later.
/// @throws InputError naming the file if it cannot be written (permissions, full disk).
/// @throws InternalError if the pictures are none, not of one grid, or not one a map.
void write_map_pictures(const std::filesystem::path& path, const std::filesystem::path& shown_as,
                        const Measurement& measurement);

/// Reads what write_map_pictures() wrote, in the order of `measurement.map`.
///
/// @return Empty if there is no such file, or it is not of this measurement: another list of maps.
/// @throws InputError if it is there and not NetCDF, or lacks a variable, or holds one of another
///         shape.
std::vector<MapPicture> read_map_pictures(const std::filesystem::path& path,
                                          const Measurement& measurement);

}  // namespace manoscope::results
