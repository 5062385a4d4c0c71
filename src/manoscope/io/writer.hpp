#pragma once

#include <filesystem>
#include <string>

#include "manoscope/core/height_map.hpp"

namespace manoscope::io {

/// Writes a map as Gwyddion Simple Field: 32-bit floats, flagged pixels as NaN.
///
/// Written to a temporary name and renamed: a killed or failed write leaves no half file.
/// @throws InputError if the file cannot be written (permissions, full disk).
void write_gsf(const std::filesystem::path& path, const HeightMap& map, const std::string& title);

/// Writes a map as NetCDF-4 (CF attributes, float64), flagged pixels as NaN.
void write_netcdf_map(const std::filesystem::path& path, const HeightMap& map,
                      const std::string& title);

/// Writes a map as comma-separated matrix with a header line that holds scale and unit.
void write_text_map(const std::filesystem::path& path, const HeightMap& map,
                    const std::string& title);

/// Writes by the extension of `path`: .gsf, .nc, .csv or .txt.
/// @throws InputError for another extension.
void write_map(const std::filesystem::path& path, const HeightMap& map, const std::string& title);

}  // namespace manoscope::io
