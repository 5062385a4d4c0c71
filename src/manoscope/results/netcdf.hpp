#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "manoscope/results/measurement.hpp"

namespace manoscope::results {

/// Writes a measurement as NetCDF-4 with CF attributes, following the schema. The bytes depend on
/// the measurement alone: no time stamp, no host name.
///
/// @param path      the file to make; one that exists is replaced.
/// @param shown_as  the name that messages use, where the file is renamed later.
/// @param files     names of the files published together, kept as the attribute `files`.
/// @throws InputError naming the file if it cannot be written (permissions, full disk).
/// @throws InternalError if an array has not the shape its dimensions say.
void write_netcdf(const std::filesystem::path& path, const std::filesystem::path& shown_as,
                  const Measurement& measurement, const std::vector<std::string>& files);

/// Reads what write_netcdf() wrote; every array comes back bit by bit.
/// @throws InputError if the file is missing, not NetCDF, lacks a variable of the schema, or holds
///         one of another shape or of absurd size; where another version of the program wrote it,
///         the message says so first.
Measurement read_netcdf(const std::filesystem::path& path);

/// The attribute `title` of a result file; nullopt where there is no readable one.
std::optional<std::string> title_in(const std::filesystem::path& path);

/// The attribute `files` of a result file; empty where there is no readable one.
std::vector<std::string> published_files(const std::filesystem::path& path);

}  // namespace manoscope::results
