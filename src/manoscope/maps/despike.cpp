#include "manoscope/maps/despike.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "manoscope/core/error.hpp"
#include "manoscope/core/flags.hpp"

namespace manoscope::maps {
namespace {

/// Distance of a pixel from the mean of its neighbours at +-1, and at +-2, along one axis,
/// whichever is smaller; where neither pair is good, from the line through two good ones of the
/// four; -1 if fewer than two are good.
double step_along(const ChannelMap& map, Index iz, Index ix, Index dz, Index dx) {
  const auto good = [&](Index k) {
    const Index jz = iz + k * dz, jx = ix + k * dx;
    return jz >= 0 && jx >= 0 && jz < map.grid.nz && jx < map.grid.nx && map.flags(jz, jx) == 0;
  };
  const auto from_line = [&](Index k, Index m) {
    const double a = map.height(iz + k * dz, ix + k * dx), b = map.height(iz + m * dz, ix + m * dx);
    return std::abs(map.height(iz, ix) - (a * static_cast<double>(m) - b * static_cast<double>(k)) /
                                             static_cast<double>(m - k));
  };
  const bool near = good(-1) && good(1), far = good(-2) && good(2);
  if (near && far) return std::min(from_line(-1, 1), from_line(-2, 2));
  if (near) return from_line(-1, 1);
  if (far) return from_line(-2, 2);
  const Index low = good(-1) ? -1 : -2, high = good(1) ? 1 : 2;
  if (good(low) && good(high)) return from_line(low, high);
  for (const Index side : {-1, 1}) {
    if (!good(side) || !good(2 * side)) continue;
    // A line drawn on beyond its points carries 2.2 times their noise: a flat guess may be nearer.
    const double here = map.height(iz, ix);
    const double flat =
        std::min(std::abs(here - map.height(iz + side * dz, ix + side * dx)),
                 std::abs(here - map.height(iz + 2 * side * dz, ix + 2 * side * dx)));
    return std::min(flat, from_line(side, 2 * side));
  }
  return -1.0;
}

/// Steps of row iz as if every pixel were good, from its third column to its third last.
void plain_steps(const Array2& height, Index iz, Array2& steps) {
  const Index n = height.cols() - 4;
  const auto pixels = [&](Index dz, Index dx) { return height.row(iz + dz).segment(2 + dx, n); };
  const auto off_mean = [&](Index dz, Index dx) {
    return (pixels(0, 0) - 0.5 * (pixels(-dz, -dx) + pixels(dz, dx))).abs();
  };
  auto row = steps.row(iz).segment(2, n);
  row = off_mean(0, 1);
  row = row.min(off_mean(0, 2));
  row = row.min(off_mean(1, 0));
  row = row.min(off_mean(2, 0));
}

/// Whether anything keeps the pixels of row iz from their plain steps: a flag on them or on one of
/// their eight neighbours, or the edge of the map.
void find_hindered(const Flags2& flags, Index iz, Flags1& hindered) {
  const Index nz = flags.rows(), nx = flags.cols();
  if (iz < 2 || iz >= nz - 2 || nx < 5) {
    hindered.setOnes();
    return;
  }
  hindered.head(2).setOnes();
  hindered.tail(2).setOnes();
  const FlagBits* here = &flags(iz, 0);
  for (Index ix = 2; ix < nx - 2; ++ix) {
    hindered[ix] = static_cast<FlagBits>(here[ix] | here[ix - 1] | here[ix + 1] | here[ix - 2] |
                                         here[ix + 2] | here[ix - nx] | here[ix + nx] |
                                         here[ix - 2 * nx] | here[ix + 2 * nx]);
  }
}

/// The smaller of a pixel's steps along x and z; -1 where either is missing.
double careful_step(const ChannelMap& map, Index iz, Index ix) {
  if (map.flags(iz, ix) != 0) return -1.0;
  const double along_x = step_along(map, iz, ix, 0, 1);
  if (along_x < 0.0) return -1.0;
  const double along_z = step_along(map, iz, ix, 1, 0);
  return along_z < 0.0 ? -1.0 : std::min(along_x, along_z);
}

/// (nz, nx) step of every pixel, -1 where there is none.
Array2 all_steps(const ChannelMap& map) {
  Array2 steps(map.grid.nz, map.grid.nx);
  Flags1 hindered(map.grid.nx);
  for (Index iz = 0; iz < map.grid.nz; ++iz) {
    find_hindered(map.flags, iz, hindered);
    if ((hindered == 0).any()) plain_steps(map.height, iz, steps);
    for (Index ix = 0; ix < map.grid.nx; ++ix) {
      if (hindered[ix] != 0) steps(iz, ix) = careful_step(map, iz, ix);
    }
  }
  return steps;
}

/// Upper decile of the steps of the 7 x 7 pixels around: a clamped corner fills a quarter of them.
double local_step(const Array2& steps, Index iz, Index ix) {
  constexpr Index kReach = 3;
  std::vector<double> around;
  for (Index jz = std::max<Index>(0, iz - kReach); jz <= std::min(steps.rows() - 1, iz + kReach);
       ++jz) {
    for (Index jx = std::max<Index>(0, ix - kReach); jx <= std::min(steps.cols() - 1, ix + kReach);
         ++jx) {
      if (steps(jz, jx) >= 0.0) around.push_back(steps(jz, jx));
    }
  }
  const auto decile =
      around.begin() + static_cast<std::ptrdiff_t>(0.9 * static_cast<double>(around.size() - 1));
  std::nth_element(around.begin(), decile, around.end());
  return *decile;
}

}  // namespace

Index flag_spikes(ChannelMap& map, Length noise, double threshold) {
  MANO_ASSERT(noise > Length{} && threshold > 0.0);
  // White noise has a decile of 1.1: there the noise itself decides.
  constexpr double kMargin = 1.3;
  const double floor = threshold * noise.si();
  const Array2 steps = all_steps(map);
  Index found = 0;
  for (Index iz = 0; iz < map.grid.nz; ++iz) {
    for (Index ix = 0; ix < map.grid.nx; ++ix) {
      if (steps(iz, ix) <= floor) continue;
      if (steps(iz, ix) <= threshold / kMargin * local_step(steps, iz, ix)) continue;
      map.flags(iz, ix) |= PixelFlag::spike;
      ++found;
    }
  }
  return found;
}

}  // namespace manoscope::maps
