#pragma once

#include <array>
#include <string_view>

#include "manoscope/core/arrays.hpp"

namespace manoscope {

/// Why a pixel of a map does not count. Bits; 0 = good.
struct PixelFlag {
  static constexpr FlagBits no_data = 1;  ///< the instrument gave no height here
  static constexpr FlagBits spike = 2;    ///< stands alone against its neighbours
  /// In a patch that stands off its surroundings by a sharp step of no known size.
  static constexpr FlagBits fringe_order = 4;
};

/// Why a station of a profile does not count. Bits; 0 = good.
struct StationFlag {
  static constexpr FlagBits no_data = 1;  ///< too few good pixels across the width
};

/// Why a pressure reading is missing or needs care. Bits; 0 = good.
///
/// The bits and their order are part of the result file (`pressure_flags`).
struct ReadingFlag {
  static constexpr FlagBits no_data = 1;             ///< no deflection at this station
  static constexpr FlagBits out_of_calibration = 2;  ///< deflection beyond every level
  static constexpr FlagBits ambiguous = 4;           ///< more than one pressure fits
  static constexpr FlagBits insensitive = 8;         ///< the wall hardly answers here
  static constexpr FlagBits outside_test_section = 16;

  /// Flags that leave no pressure: the reading holds NaN there.
  static constexpr FlagBits no_answer = no_data | out_of_calibration | ambiguous | insensitive;
};

/// How many have one of the bits.
inline Index count_set(const Flags2& flags, FlagBits bits) {
  const Index n_columns = flags.cols();
  Index count = 0;
  for (Index row = 0; row < flags.rows(); ++row) {
    const FlagBits* const at = flags.data() + row * n_columns;
    unsigned in_row = 0;  // narrower than Index, and no bool: so that g++ takes many at a time
    for (Index column = 0; column < n_columns; ++column) {
      in_row += static_cast<unsigned>(at[column] & bits) > 0U ? 1U : 0U;
    }
    count += in_row;
  }
  return count;
}

struct FlagName {
  FlagBits bit;
  std::string_view name;
  std::string_view meaning;
};

/// Bit, name and meaning of every reading flag, in the order of the bits.
inline constexpr std::array<FlagName, 5> kReadingFlags{{
    {ReadingFlag::no_data, "no_data", "too few good pixels across the width"},
    {ReadingFlag::out_of_calibration, "out_of_calibration",
     "deflection outside the range of the calibration"},
    {ReadingFlag::ambiguous, "ambiguous", "more than one pressure fits the deflection"},
    {ReadingFlag::insensitive, "insensitive", "the wall hardly answers to pressure here"},
    {ReadingFlag::outside_test_section, "outside_test_section",
     "the clamped ends are felt, or the wall is too stiff: outside the test section"},
}};

}  // namespace manoscope
