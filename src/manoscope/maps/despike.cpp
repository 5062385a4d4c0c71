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
  Array2 steps = Array2::Constant(map.grid.nz, map.grid.nx, -1.0);
  for (Index iz = 0; iz < map.grid.nz; ++iz) {
    for (Index ix = 0; ix < map.grid.nx; ++ix) {
      if (map.flags(iz, ix) != 0) continue;
      const double along_x = step_along(map, iz, ix, 0, 1);
      if (along_x < 0.0) continue;
      const double along_z = step_along(map, iz, ix, 1, 0);
      if (along_z < 0.0) continue;
      steps(iz, ix) = std::min(along_x, along_z);
    }
  }
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
