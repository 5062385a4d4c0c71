#pragma once

#include <cstdint>
#include <limits>

#include "manoscope/core/arrays.hpp"

namespace manoscope {

/// Whole numbers of steps, row-major (n_z, n_x).
using Counts2 = Eigen::Array<std::int16_t, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Deflection zeta(x, z) of one map for eyes, not for numbers: rounded to a step that is about half
/// the noise of one pixel, so that it travels small.
///
/// zeta = counts * step, unit m, positive away from the fluid; kMissing where there is none.
struct MapPicture {
  static constexpr std::int16_t kMissing = std::numeric_limits<std::int16_t>::min();
  /// No count is larger, so that the difference of two is no larger than an int16 holds.
  static constexpr std::int16_t kLargest = 16383;

  Array1 x, z;  ///< (n_x), (n_z) m, centres of the cells in the channel's frame, evenly spaced
  double step = 0.0;  ///< m
  Counts2 counts;     ///< (n_z, n_x)
};

}  // namespace manoscope
