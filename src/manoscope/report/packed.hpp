#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "manoscope/core/map_picture.hpp"

namespace manoscope::report {

/// A text as report.html carries it, for DecompressionStream("deflate"): base64 of its zlib stream.
std::string pack_text(std::string_view text);

/// The counts of a picture as report.html carries them, for DecompressionStream("deflate"):
/// base64 of the zlib stream of 2 n bytes, n values in the order of the rows.
///
/// A value is a count less the last one before it that is not missing (0 before the first), folded
/// to 2 d for d >= 0 and -2 d - 1 for d < 0, modulo 2^16; kMissingCode stands for a missing one. Of
/// all values the low bytes come first, then the high bytes, which are nearly all 0.
std::string pack_counts(const Counts2& counts);

inline constexpr std::uint16_t kMissingCode = 0xFFFF;

}  // namespace manoscope::report
