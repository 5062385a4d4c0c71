#include "manoscope/maps/despike.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "manoscope/core/error.hpp"
#include "manoscope/core/flags.hpp"
#include "manoscope/maps/row_window.hpp"

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

/// The smaller of a pixel's steps along x and z; -1 where either is missing.
double careful_step(const ChannelMap& map, Index iz, Index ix) {
  if (map.flags(iz, ix) != 0) return -1.0;
  const double along_x = step_along(map, iz, ix, 0, 1);
  if (along_x < 0.0) return -1.0;
  const double along_z = step_along(map, iz, ix, 1, 0);
  return along_z < 0.0 ? -1.0 : std::min(along_x, along_z);
}

/// Steps of a row from its good pairs at +-1 and +-2; kUnknown where an axis has none, or the pixel
/// itself is flagged. `found` lists the pixels above `floor`.
constexpr double kUnknown = RowWindow::kAbsent;

struct RowSteps {
  template <class Lanes>
  [[gnu::always_inline]] static void run(const RowWindow* window, Index nx, double floor,
                                         double* steps, Index* found, Index* n_found) {
    const double *here = window->row(0), *above = window->row(-1), *below = window->row(1);
    const double *far_above = window->row(-2), *far_below = window->row(2);
    const Lanes half = Lanes::all(0.5), one = Lanes::all(1.0), unknown = Lanes::all(kUnknown);
    const Lanes known = Lanes::all(0.1 * kUnknown), least = Lanes::all(floor);
    constexpr Index kBlock = 2 * numerics::kLanes;
    double hits[numerics::kLanes];
    Index n = 0;
    for (Index block = 0; block < nx; block += kBlock) {
      const Index end = std::min(block + kBlock, nx);
      Lanes above_floor = Lanes::all(0.0);
      for (Index start = block; start < end; start += numerics::kLanes) {
        const auto off_mean = [&](const Lanes& at, const double* a, const double* b)
            __attribute__((always_inline)) {
          return size_of(at - half * (Lanes::load(a + start) + Lanes::load(b + start)));
        };
        const Lanes at = Lanes::load(here + start);
        const Lanes along_x =
            lesser(off_mean(at, here - 1, here + 1), off_mean(at, here - 2, here + 2));
        const Lanes along_z =
            lesser(off_mean(at, above, below), off_mean(at, far_above, far_below));
        const Lanes is_known = is_below(greater(along_x, along_z), known);
        const Lanes step = lesser(along_x, along_z) + (one - is_known) * unknown;
        step.store(steps + start);
        above_floor = above_floor + is_below(least, step);
      }
      above_floor.store(hits);
      if (numerics::sum_of_lanes(hits) == 0.0) continue;
      for (Index ix = block; ix < end; ++ix) {
        if (steps[ix] > floor) found[n++] = ix;
      }
    }
    *n_found = n;
  }
};

/// (nz, nx + kLanes) steps, and the good pixels whose step may exceed the floor.
struct Steps {
  Array2 plain;
  std::vector<std::pair<Index, Index>> suspects;

  Steps(const ChannelMap& map, double floor) : plain(map.grid.nz, map.grid.nx + numerics::kLanes) {
    RowWindow window(map);
    std::vector<Index> found(static_cast<std::size_t>(map.grid.nx));
    for (Index iz = 0; iz < map.grid.nz; ++iz) {
      window.move_to(iz);
      Index n = 0;
      numerics::run_in_lanes<RowSteps>(numerics::best_instructions(), &window, map.grid.nx, floor,
                                       &plain(iz, 0), found.data(), &n);
      for (Index k = 0; k < n; ++k) {
        const Index ix = found[static_cast<std::size_t>(k)];
        if (map.flags(iz, ix) == 0) suspects.emplace_back(iz, ix);
      }
    }
  }
  /// Step of a pixel, -1 where there is none.
  double of(const ChannelMap& map, Index iz, Index ix) const {
    return plain(iz, ix) < 0.1 * kUnknown ? plain(iz, ix) : careful_step(map, iz, ix);
  }
};

/// Whether a step exceeds `factor` times the upper decile of the steps of the 7 x 7 pixels around:
/// a clamped corner fills a quarter of them.
bool stands_out(const ChannelMap& map, const Steps& steps, Index iz, Index ix, double factor) {
  constexpr Index kReach = 3;
  const double step = steps.of(map, iz, ix);
  Index n = 0, n_exceeded = 0;
  for (Index jz = std::max<Index>(0, iz - kReach); jz <= std::min(map.grid.nz - 1, iz + kReach);
       ++jz) {
    for (Index jx = std::max<Index>(0, ix - kReach); jx <= std::min(map.grid.nx - 1, ix + kReach);
         ++jx) {
      const double around = steps.of(map, jz, jx);
      n += static_cast<Index>(around >= 0.0);
      n_exceeded += static_cast<Index>(around >= 0.0 && step > factor * around);
    }
  }
  return n_exceeded > static_cast<Index>(0.9 * static_cast<double>(n - 1));
}

}  // namespace

Index flag_spikes(ChannelMap& map, Length noise, double threshold) {
  MANO_ASSERT(noise > Length{} && threshold > 0.0);
  // White noise has a decile of 1.1: there the noise itself decides.
  constexpr double kMargin = 1.3;
  const double floor = threshold * noise.si();
  const Steps steps(map, floor);
  std::vector<std::pair<Index, Index>> spikes;
  for (const auto& [iz, ix] : steps.suspects) {
    if (steps.of(map, iz, ix) <= floor) continue;
    if (stands_out(map, steps, iz, ix, threshold / kMargin)) spikes.emplace_back(iz, ix);
  }
  for (const auto& [iz, ix] : spikes) map.flags(iz, ix) |= PixelFlag::spike;
  return static_cast<Index>(spikes.size());
}

}  // namespace manoscope::maps
