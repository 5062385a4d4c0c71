#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "manoscope/core/grid.hpp"
#include "manoscope/io/file_units.hpp"

namespace manoscope::io {

/// First bytes of every Gwyddion Simple Field.
inline constexpr std::string_view kGsfMagic = "Gwyddion Simple Field 1.0\n";

/// What the header of a Gwyddion Simple Field says.
struct GsfLayout {
  std::string title, file_unit;
  CameraGrid grid;  ///< pitch 0 where the file names no size, or none that is a length
  SiUnit unit;
  std::uint64_t data = 0;  ///< offset of the first of the grid's little-endian 32-bit floats
};

/// Reads the header and checks it against the size of the file.
/// @param head  the file from its beginning, at least up to the end of the header.
/// @throws InputError(where, ...) naming what is wrong.
GsfLayout read_gsf_header(std::string_view head, std::uint64_t file_bytes,
                          const std::string& where);

}  // namespace manoscope::io
