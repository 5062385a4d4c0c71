#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "manoscope/core/units.hpp"

namespace manoscope::io {

/// What the header lines of a text map may say about it.
struct TextHeader {
  std::string name;                        ///< of the channel, "" if none
  std::optional<Length> size_x, size_y;    ///< of the whole map
  std::optional<Length> pitch_x, pitch_y;  ///< of one pixel
  std::string unit;                        ///< of the values, as written; "" if none
};

/// Understands one header line `key: value` or `key = value`, in any case, in English or German,
/// with or without a leading comment sign: "# Width: 16.3 mm", "% pitch x = 1,5 um", "# Breite:
/// ...".
///
/// Keys of a size without a unit count pixels and are passed over, as are keys that mean nothing
/// here.
/// @return false if the line is not of that form.
/// @throws InputError(where, ...) for a known key whose value is not a positive length, or that
///         contradicts an earlier line.
bool read_header_line(std::string_view line, TextHeader& header, const std::string& where);

}  // namespace manoscope::io
