#include "manoscope/maps/column_weights.hpp"

#include <algorithm>

namespace manoscope::maps {

std::array<double, 2> line_weights(double a, double b, double low, double high) {
  if (a >= low && b <= high) return {0.5 * (b - a), 0.5 * (b - a)};
  const double from = std::max(a, low), to = std::min(b, high);
  if (to <= from) return {0.0, 0.0};
  const double middle = (0.5 * (from + to) - a) / (b - a);  // the line's value at the centre
  return {(to - from) * (1.0 - middle), (to - from) * middle};
}

ColumnWeights::ColumnWeights(const ChannelGrid& grid, double width) {
  const double half = 0.5 * width;
  while (first < grid.nz && grid.z(first) <= -half) ++first;
  last = first;
  while (last < grid.nz && grid.z(last) < half) ++last;
  --first;
  exist = first >= 0 && last < grid.nz && last - first >= 3;
  if (!exist) return;
  weight.assign(static_cast<std::size_t>(last - first + 1), 0.0);
  for (Index iz = first; iz < last; ++iz) {
    const auto [lower, upper] = line_weights(grid.z(iz), grid.z(iz + 1), -half, half);
    weight[static_cast<std::size_t>(iz - first)] += lower / width;
    weight[static_cast<std::size_t>(iz - first + 1)] += upper / width;
  }
  for (Index iz = first; iz <= last; ++iz) {
    sum += of(iz);
    squares += of(iz) * of(iz);
    mean_z += of(iz) * grid.z(iz);
  }
}

void ColumnGaps::remove(const ColumnWeights& full, const ChannelGrid& grid, Index iz) {
  measured -= full.of(iz);
  mean_z -= full.of(iz) * grid.z(iz);
  squares -= full.of(iz) * full.of(iz);
}

void ColumnGaps::grow(const ColumnWeights& full, const ChannelGrid& grid, Index iz, double by) {
  const double before = full.of(iz) + (iz == grown_row_ ? grown_ : 0.0);
  measured += by;
  mean_z += by * grid.z(iz);
  squares += by * (2.0 * before + by);
  grown_row_ = iz;
  grown_ = by;
}

double ColumnGaps::close(const ColumnWeights& full, const ChannelGrid& grid, Index lower,
                         Index upper, double width) {
  for (Index iz = lower + 1; iz < upper; ++iz) remove(full, grid, iz);
  const double gap = grid.z(upper) - grid.z(lower), cube = gap * gap * gap;
  const double by = 0.5 * (gap - grid.pitch_z.si()) / width;
  grow(full, grid, lower, by);
  grow(full, grid, upper, by);
  sixth += cube * cube;
  return by;
}

}  // namespace manoscope::maps
