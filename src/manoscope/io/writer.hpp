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

/// Writes a map as TIFF of 32-bit floats in m, flagged pixels as NaN, with the scale as ImageJ
/// reads it.
void write_tiff_map(const std::filesystem::path& path, const HeightMap& map,
                    const std::string& title);

/// Writes a map as VTK ImageData: point arrays "height" (float64, m, NaN where flagged) and
/// "flags".
void write_vti_map(const std::filesystem::path& path, const HeightMap& map);

/// Writes a map as ISO 5436-2 X3P: float64, flagged pixels as NaN and in the validity mask.
void write_x3p(const std::filesystem::path& path, const HeightMap& map);

/// The extensions that write_map() knows, for help texts: ".gsf, .nc, ...".
std::string written_formats();

/// The name of one of several files: "out-03.gsf" of "out.gsf" for number 3 of up to 12.
std::filesystem::path numbered(const std::filesystem::path& path, int number, int largest);

/// Writes by the extension of `path`; see written_formats().
/// @throws InputError for another extension.
void write_map(const std::filesystem::path& path, const HeightMap& map, const std::string& title);

}  // namespace manoscope::io
