#pragma once

#include <array>
#include <cstdint>

namespace manoscope {

/// Red, green and blue, 0 to 255.
using Rgb = std::array<std::uint8_t, 3>;

/// The colour map viridis at `place` in [0, 1], from dark violet to yellow; beyond, its ends.
///
/// Linear between 17 entries of its table of 256 (S. van der Walt and N. Smith, 2015), within 3 of
/// it in each colour.
Rgb viridis(double place);

}  // namespace manoscope
