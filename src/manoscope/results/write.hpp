#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "manoscope/results/measurement.hpp"

namespace manoscope::results {

/// One more file to be published together with the result, e.g. {"report.html", bytes}.
struct ExtraFile {
  std::filesystem::path name;  ///< relative to the result folder
  std::string bytes;
};

/// Writes result.nc, pressure.csv, drops.csv, maps.nc (where there are pictures of the maps) and
/// the extra files to `folder`, all or nothing.
///
/// Everything is first written and synced in a hidden folder inside `folder`; then the old result
/// is withdrawn (result.nc first) and the new files are renamed into place, result.nc last. A
/// killed run therefore leaves the old result or none, and never half a file. Other files in
/// `folder` stay.
/// @throws InputError naming the file if the folder cannot be made or written (permissions, full
/// disk).
void write_result(const std::filesystem::path& folder, const Measurement& measurement,
                  const std::vector<ExtraFile>& extra_files);

/// Looks whether a result stands in `folder` that one of this title would replace.
///
/// A result of the same title is an earlier one of the same experiment, and is replaced. One of
/// another title is another experiment's, and is not.
/// @return True if there is a result to replace.
/// @throws InputError if it is another experiment's, or a result.nc that cannot be read, unless
///         `overwrite`.
bool check_destination(const std::filesystem::path& folder, const std::string& title,
                       bool overwrite);

/// Reads what write_result() left.
/// @param folder_or_file  the result folder or its result.nc.
/// @throws InputError if it is missing, not a NetCDF file, or lacks a variable of the schema.
Measurement read_result(const std::filesystem::path& folder_or_file);

/// The pictures of the maps that stand beside a result, for its `map_picture`.
/// @return Empty if there are none, or they are of another measurement.
/// @throws InputError if maps.nc is there and cannot be read.
std::vector<MapPicture> read_maps(const std::filesystem::path& folder_or_file,
                                  const Measurement& measurement);

}  // namespace manoscope::results
