#pragma once

#include <algorithm>

#include "manoscope/core/arrays.hpp"

namespace manoscope::maps {

/// Centres of cells of `per_cell` samples at first, first + pitch, ...; the last may hold fewer.
inline Array1 cell_centres(Index n, Index per_cell, double first, double pitch) {
  Array1 result((n + per_cell - 1) / per_cell);
  for (Index cell = 0; cell < result.size(); ++cell) {
    const Index begin = cell * per_cell, end = std::min(n, begin + per_cell);
    result[cell] = first + 0.5 * static_cast<double>(begin + end - 1) * pitch;
  }
  return result;
}

}  // namespace manoscope::maps
