#include "manoscope/maps/deflection_picture.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "manoscope/core/error.hpp"
#include "manoscope/maps/cell_centres.hpp"

namespace manoscope::maps {
namespace {

Index cells(Index n, Index per_cell) { return (n + per_cell - 1) / per_cell; }

/// Pixels along each side of a cell.
Index cell_side(const ChannelGrid& grid, Index most_cells) {
  Index side = 1;
  while (cells(grid.nx, side) * cells(grid.nz, side) > most_cells) ++side;
  return side;
}

/// Means over cells of `side` by `side` pixels; NaN where none counts.
Array2 cell_means(const DeflectionMap& map, Index side) {
  const ChannelGrid& grid = map.grid();
  const Index n_x = cells(grid.nx, side), n_z = cells(grid.nz, side);
  Array2 sum = Array2::Zero(n_z, n_x), count = Array2::Zero(n_z, n_x);
  for (Index iz = 0; iz < grid.nz; ++iz) {
    for (Index ix = 0; ix < grid.nx; ++ix) {
      if (map.flags()(iz, ix) != 0) continue;
      sum(iz / side, ix / side) += map.zeta()(iz, ix);
      count(iz / side, ix / side) += 1.0;
    }
  }
  return (count > 0.0).select(sum / count.max(1.0), std::numeric_limits<double>::quiet_NaN());
}

double step_of(const DeflectionMap& map, const Array2& zeta) {
  double largest = 0.0;
  for (const double value : zeta.reshaped()) {
    if (std::isfinite(value)) largest = std::max(largest, std::abs(value));
  }
  const double least = largest / static_cast<double>(MapPicture::kLargest - 1);
  const double step = std::max(0.5 * map.noise().si(), least);
  return step > 0.0 ? step : 1e-9;  // a flat map without noise
}

}  // namespace

MapPicture picture_deflection(const DeflectionMap& map, Index most_cells) {
  MANO_ASSERT(most_cells >= 1);
  const ChannelGrid& grid = map.grid();
  const Index side = cell_side(grid, most_cells);
  const Array2 zeta = cell_means(map, side);
  MapPicture picture;
  picture.x = cell_centres(grid.nx, side, grid.x(0), grid.pitch_x.si());
  picture.z = cell_centres(grid.nz, side, grid.z(0), grid.pitch_z.si());
  picture.step = step_of(map, zeta);
  picture.counts = zeta.unaryExpr([&](double value) {
    return std::isfinite(value) ? static_cast<std::int16_t>(std::lround(value / picture.step))
                                : MapPicture::kMissing;
  });
  return picture;
}

}  // namespace manoscope::maps
