#include "mesh_pair.hpp"

#include <algorithm>
#include <limits>

#include "manoscope/core/error.hpp"

namespace manoscope::navier_stokes {

int coarser_cells(int n) {
  MANO_ASSERT(n >= kFewestCells);
  return (2 * n + 1) / 3;
}

double uncertainty_of_difference(const std::vector<std::pair<int, int>>& cells) {
  double ratio = std::numeric_limits<double>::infinity();
  for (const auto& [fine, coarse] : cells) {
    ratio = std::min(ratio, static_cast<double>(fine) / coarse);
  }
  MANO_ASSERT(ratio > 1.0);
  return 1.0 / (ratio - 1.0);
}

}  // namespace manoscope::navier_stokes
