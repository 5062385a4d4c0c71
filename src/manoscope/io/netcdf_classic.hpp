#pragma once

#include <string>
#include <string_view>

namespace manoscope::io {

/// True if the bytes begin as a classic NetCDF file does (CDF-1, CDF-2 or CDF-5).
bool is_classic_netcdf(std::string_view bytes);

/// Walks the header of a classic NetCDF file and makes sure that it can be trusted: every count,
/// name, identifier and data offset lies inside the file.
///
/// The NetCDF library makes room for what a header announces before it looks at the file's size,
/// and reads zeros where a file was cut off. Source of the layout: "NetCDF classic format
/// specification", NetCDF User's Guide, appendix B.
/// @param where  the file's name, for messages.
/// @throws InputError naming the file and the offset of the first thing that cannot be.
void check_classic_netcdf(std::string_view bytes, const std::string& where);

}  // namespace manoscope::io
