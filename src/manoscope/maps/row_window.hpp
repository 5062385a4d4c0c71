// A few rows of a map at a time, for loops over kLanes of its pixels.
#pragma once

#include <algorithm>
#include <vector>

#include "manoscope/maps/channel_map.hpp"
#include "manoscope/numerics/lanes.hpp"

namespace manoscope::maps {

/// The rows around one, flagged pixels and those beyond the map at kAbsent.
class RowWindow {
 public:
  static constexpr Index kReach = 2;
  static constexpr double kAbsent = 1e200;

  explicit RowWindow(const ChannelMap& map)
      : map_(map), stride_(map.grid.nx + 2 * kReach + numerics::kLanes) {
    rows_.assign(static_cast<std::size_t>(kRows * stride_), kAbsent);
    for (Index iz = 0; iz < kReach; ++iz) fill(iz);
  }
  /// Makes row iz the middle one; called for 0, 1, 2 ...
  void move_to(Index iz) {
    middle_ = iz;
    fill(iz + kReach);
  }
  /// First pixel of a row, `dz` beyond the middle one.
  const double* row(Index dz) const { return rows_.data() + offset(middle_ + dz); }

 private:
  static constexpr Index kRows = 2 * kReach + 1;

  Index offset(Index iz) const { return (iz + kRows) % kRows * stride_ + kReach; }
  void fill(Index iz) {
    double* const to = rows_.data() + offset(iz);
    const Index nx = map_.grid.nx;
    if (iz >= map_.grid.nz) {
      std::fill(to, to + nx, kAbsent);
      return;
    }
    const double* const height = map_.height.data() + iz * nx;
    const FlagBits* const flags = map_.flags.data() + iz * nx;
    for (Index ix = 0; ix < nx; ++ix) to[ix] = flags[ix] == 0 ? height[ix] : kAbsent;
  }

  const ChannelMap& map_;
  Index stride_, middle_ = 0;
  std::vector<double> rows_;
};

}  // namespace manoscope::maps
