#include "manoscope/maps/fringe_islands.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "manoscope/core/flags.hpp"
#include "manoscope/numerics/robust.hpp"

namespace manoscope::maps {
namespace {

constexpr Index kLongest = 24;   // pixels along the flow
constexpr Index kAround = 2;     // pixels beyond a patch that may belong to it
constexpr Index kRowsApart = 6;  // rows between two runs whose ends may hide in missing pixels
constexpr Index kFewest = 4;     // pixels of a patch
constexpr double kWhole = 0.15;  // distance from a whole number of half wavelengths
constexpr double kNoises = 5.0;  // deviations of the noise that a pixel may be off

/// Pixels [first, last] of one row between a jump and the same jump back.
struct Run {
  Index iz, first, last;
  int order;  ///< half wavelengths
};

/// Touching runs of one order, and the box around them.
struct Island {
  Index top, bottom, left, right;
  int order;
  Index n_pixels = 0;  ///< of the runs
};

/// The whole number of half wavelengths that a jump is; 0 if it is none.
int whole_order(double jump, double half, double slack) {
  const double order = std::round(jump / half);
  return std::abs(jump - order * half) <= slack ? static_cast<int>(order) : 0;
}

/// The good pixels from one on, stepping `by`, up to the first missing one; none if that is far.
std::optional<Run> up_to_gap(const ChannelMap& map, Index iz, Index ix, Index by, int order) {
  Index at = ix;
  while (std::abs(at - ix) < kLongest) {
    const Index next = at + by;
    if (next < 0 || next >= map.grid.nx) return std::nullopt;
    if (map.flags(iz, next) != 0) return Run{iz, std::min(ix, at), std::max(ix, at), order};
    at = next;
  }
  return std::nullopt;
}

/// Runs between jumps along x that come back by the same whole number of half wavelengths, or that
/// end in missing pixels.
std::vector<Run> find_runs(const ChannelMap& map, const std::vector<FringeJump>& jumps, double half,
                           double noise) {
  const Index nx = map.grid.nx;
  const double slack = kWhole * half + kNoises * noise;
  std::vector<Run> runs;
  // Of a jump without a counterpart either side may be the patch: what is none fails later.
  const auto half_open = [&](const FringeJump& jump) {
    const int order = whole_order(jump.size, half, slack);
    if (order == 0) return;
    const Index iz = jump.from / nx, ix = jump.from % nx;
    if (const auto run = up_to_gap(map, iz, ix + 1, 1, order)) runs.push_back(*run);
    if (const auto run = up_to_gap(map, iz, ix, -1, -order)) runs.push_back(*run);
  };
  const FringeJump* open = nullptr;
  for (const FringeJump& jump : jumps) {
    if (jump.to != jump.from + 1) continue;
    if (open != nullptr && open->from / nx == jump.from / nx &&
        jump.from - open->from <= kLongest && std::abs(open->size + jump.size) <= slack) {
      const int order = whole_order(0.5 * (open->size - jump.size), half, slack);
      if (order != 0) {
        runs.push_back({jump.from / nx, open->to % nx, jump.from % nx, order});
        open = nullptr;
        continue;
      }
    }
    if (open != nullptr) half_open(*open);
    open = &jump;
  }
  if (open != nullptr) half_open(*open);
  return runs;
}

/// @param runs  by rows, as find_runs() gives them.
std::vector<Island> join_runs(const std::vector<Run>& runs) {
  std::vector<Island> islands;
  for (const Run& run : runs) {
    const auto touches = [&](const Island& island) {
      return island.order == run.order && run.iz <= island.bottom + kRowsApart &&
             run.first <= island.right + kAround && run.last >= island.left - kAround &&
             std::max(run.last, island.right) - std::min(run.first, island.left) < kLongest;
    };
    const auto found = std::find_if(islands.begin(), islands.end(), touches);
    if (found == islands.end()) {
      islands.push_back({run.iz, run.iz, run.first, run.last, run.order, run.last - run.first + 1});
      continue;
    }
    found->bottom = run.iz;
    found->left = std::min(found->left, run.first);
    found->right = std::max(found->right, run.last);
    found->n_pixels += run.last - run.first + 1;
  }
  return islands;
}

/// The wall beside a patch, as a straight line along one row.
struct Beside {
  double x, height, slope;
  double at(Index ix) const { return height + slope * (static_cast<double>(ix) - x); }
};

/// From the nearest five good pixels on either side, at most 15 away; none with fewer than three.
std::optional<Beside> wall_beside(const ChannelMap& map, Index iz, Index first, Index last) {
  constexpr std::size_t kFewestBeside = 3, kMostBeside = 5;
  constexpr Index kReach = 15;
  std::array<double, 2> place{}, height{};
  for (const int side : {0, 1}) {
    const Index from = side == 0 ? first : last, by = side == 0 ? -1 : 1;
    std::vector<double> heights;
    double sum = 0.0;
    for (Index step = 1; step <= kReach && heights.size() < kMostBeside; ++step) {
      const Index ix = from + by * step;
      if (ix < 0 || ix >= map.grid.nx) break;
      if (map.flags(iz, ix) != 0) continue;
      heights.push_back(map.height(iz, ix));
      sum += static_cast<double>(ix);
    }
    if (heights.size() < kFewestBeside) return std::nullopt;
    place[static_cast<std::size_t>(side)] = sum / static_cast<double>(heights.size());
    height[static_cast<std::size_t>(side)] = numerics::median(heights);
  }
  return Beside{place[0], height[0], (height[1] - height[0]) / (place[1] - place[0])};
}

/// What is to be done with the pixels about one island.
struct Plan {
  std::vector<Index> lift, flag;
  Index n_wall = 0;  ///< pixels that lie where the wall is
};

Plan plan_island(const ChannelMap& map, const Island& island, double jump, double allowed) {
  Plan plan;
  const Index left = std::max<Index>(0, island.left - kAround);
  const Index right = std::min(map.grid.nx - 1, island.right + kAround);
  const Index bottom = std::min(map.grid.nz - 1, island.bottom + kAround);
  for (Index iz = std::max<Index>(0, island.top - kAround); iz <= bottom; ++iz) {
    const auto wall = wall_beside(map, iz, left, right);
    const bool around = iz < island.top || iz > island.bottom;
    if (!wall && around) continue;  // hidden, and none of the runs' rows
    for (Index ix = left; ix <= right; ++ix) {
      if (map.flags(iz, ix) != 0) continue;
      const Index here = iz * map.grid.nx + ix;
      const double off = wall ? map.height(iz, ix) - wall->at(ix) : 0.5 * jump;
      if (std::abs(off) <= allowed) {
        ++plan.n_wall;
      } else if (std::abs(off - jump) <= allowed) {
        plan.lift.push_back(here);
      } else {
        plan.flag.push_back(here);
      }
    }
  }
  return plan;
}

}  // namespace

FringePatches mend_fringe_islands(ChannelMap& map, const std::vector<FringeJump>& jumps,
                                  Length noise, Length wavelength) {
  constexpr double kMostUnclear = 0.1;  // of the pixels about a patch
  FringePatches found;
  const double half = 0.5 * wavelength.si();
  for (const Island& island : join_runs(find_runs(map, jumps, half, noise.si()))) {
    if (island.n_pixels < kFewest) continue;
    const double jump = island.order * half;
    // A third of the jump keeps both kinds apart whatever the noise.
    const double allowed = std::min(half / 3.0, std::max(kWhole * half, kNoises * noise.si()));
    const Plan plan = plan_island(map, island, jump, allowed);
    const auto n_unclear = static_cast<double>(plan.flag.size());
    const auto n_clear = static_cast<double>(plan.n_wall) + static_cast<double>(plan.lift.size());
    // Most runs' pixels must be where the jump takes them, and the rest where the wall is.
    if (n_unclear > kMostUnclear * n_clear ||
        static_cast<double>(plan.lift.size()) < 0.8 * static_cast<double>(island.n_pixels)) {
      continue;
    }
    for (const Index pixel : plan.lift) map.height.data()[pixel] -= jump;
    for (const Index pixel : plan.flag) map.flags.data()[pixel] |= PixelFlag::fringe_order;
    ++found.mended;
    found.mended_pixels += static_cast<Index>(plan.lift.size());
    found.flagged_pixels += static_cast<Index>(plan.flag.size());
  }
  return found;
}

}  // namespace manoscope::maps
