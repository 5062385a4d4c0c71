#include "manoscope/maps/fringe_islands.hpp"

#include <Eigen/QR>
#include <algorithm>
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
  int order;            ///< half wavelengths
  bool closed = false;  ///< both jumps are seen; else one end lies at missing pixels
};

/// Touching runs of one order, and the box around them.
struct Island {
  Index top, bottom, left, right;
  int order;
  std::vector<Run> runs;
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
        runs.push_back({jump.from / nx, open->to % nx, jump.from % nx, order, true});
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
      islands.push_back({run.iz, run.iz, run.first, run.last, run.order, {run}});
      continue;
    }
    found->bottom = run.iz;
    found->left = std::min(found->left, run.first);
    found->right = std::max(found->right, run.last);
    found->runs.push_back(run);
  }
  return islands;
}

/// Pixels from one up to another, both included.
struct Span {
  Index first, last;
  Index size() const { return last - first + 1; }
};

/// Heights of one row over a span, missing ones between good neighbours on straight lines; none if
/// more than kLongestGap are missing in a row, or the first or last.
std::optional<Array1> filled_row(const ChannelMap& map, Index iz, const Span& span) {
  constexpr Index kLongestGap = 6;
  Array1 row(span.size());
  Index last_good = -1;
  for (Index i = 0; i < span.size(); ++i) {
    if (map.flags(iz, span.first + i) != 0) continue;
    row[i] = map.height(iz, span.first + i);
    if (i - last_good > kLongestGap + 1 || (last_good < 0 && i > 0)) return std::nullopt;
    for (Index k = last_good + 1; k < i; ++k) {
      const double share = static_cast<double>(k - last_good) / static_cast<double>(i - last_good);
      row[k] = row[last_good] + share * (row[i] - row[last_good]);
    }
    last_good = i;
  }
  return last_good == span.size() - 1 ? std::optional(row) : std::nullopt;
}

/// How the wall rises along the flow about a box of pixels, as the rows above and below show it.
class WallAround {
 public:
  WallAround(const ChannelMap& map, Index top, Index bottom, const Span& box)
      : map_(map),
        box_(box),
        span_{std::max<Index>(0, box.first - kReach),
              std::min(map.grid.nx - 1, box.last + kReach)} {
    add_shape(top - 1, -1);
    add_shape(bottom + 1, 1);
  }

  /// The wall's heights along a row of the box: a straight line and the shapes of the rows above
  /// and below, each with a factor, through the good pixels beside the box. None with fewer than
  /// three on either side.
  std::optional<Array1> row(Index iz) const {
    std::vector<Index> beside;
    Index n_before = 0;
    for (Index i = 0; i < span_.size(); ++i) {
      const Index ix = span_.first + i;
      if ((ix >= box_.first && ix <= box_.last) || map_.flags(iz, ix) != 0) continue;
      beside.push_back(i);
      n_before += ix < box_.first ? 1 : 0;
    }
    const auto n = static_cast<Index>(beside.size());
    if (n_before < kFewestBeside || n - n_before < kFewestBeside) return std::nullopt;
    Eigen::VectorXd factors = fit(iz, beside);
    std::vector<double> off;
    for (const Index i : beside) off.push_back(std::abs(height(iz, i) - terms(i).dot(factors)));
    const double most = kOutlier * numerics::median(off);
    std::vector<Index> kept;
    for (std::size_t k = 0; k < off.size(); ++k) {
      if (std::abs(height(iz, beside[k]) - terms(beside[k]).dot(factors)) <= most) {
        kept.push_back(beside[k]);
      }
    }
    if (static_cast<Index>(kept.size()) > 2 * n_terms()) factors = fit(iz, kept);
    Array1 wall(box_.size());
    for (Index i = 0; i < box_.size(); ++i) {
      wall[i] = terms(box_.first - span_.first + i).dot(factors);
    }
    return wall;
  }

 private:
  static constexpr Index kReach = 15;  // pixels beside the box that are looked at
  static constexpr Index kFewestBeside = 3;
  static constexpr double kOutlier = 5.0;  // median residuals: beyond, another patch or a spike

  /// Mean of the nearest rows on one side of the box.
  void add_shape(Index iz, Index by) {
    constexpr int kRows = 4, kTried = 12;
    Array1 sum = Array1::Zero(span_.size());
    int n = 0;
    for (int tried = 0; tried < kTried && n < kRows; ++tried, iz += by) {
      if (iz < 0 || iz >= map_.grid.nz) break;
      const auto filled = filled_row(map_, iz, span_);
      if (!filled) continue;
      sum += *filled;
      ++n;
    }
    if (n == 0) return;
    const double rise = sum.maxCoeff() - sum.minCoeff();
    if (rise > 0.0) shapes_.emplace_back((sum - sum.minCoeff()) / rise);
  }
  double height(Index iz, Index i) const { return map_.height(iz, span_.first + i); }
  Index n_terms() const { return 2 + static_cast<Index>(shapes_.size()); }
  Eigen::VectorXd terms(Index i) const {
    Eigen::VectorXd all(n_terms());
    all[0] = 1.0;
    all[1] = static_cast<double>(i) / static_cast<double>(span_.size());
    for (std::size_t k = 0; k < shapes_.size(); ++k) all[2 + static_cast<Index>(k)] = shapes_[k][i];
    return all;
  }
  Eigen::VectorXd fit(Index iz, const std::vector<Index>& places) const {
    const auto n = static_cast<Index>(places.size());
    Matrix design(n, n_terms());
    Eigen::VectorXd values(n);
    for (Index k = 0; k < n; ++k) {
      design.row(k) = terms(places[static_cast<std::size_t>(k)]);
      values[k] = height(iz, places[static_cast<std::size_t>(k)]);
    }
    return design.colPivHouseholderQr().solve(values);
  }

  const ChannelMap& map_;
  Span box_, span_;
  std::vector<Array1> shapes_;
};

/// What is to be done with the pixels about one island.
struct Plan {
  std::vector<Index> lift, flag;  ///< ascending
  Index n_wall = 0;               ///< pixels that lie where the wall is

  /// Pixels of those runs that are to be lifted for the most part. The others are none: noise
  /// passed for a jump, and what follows it up to the next missing pixel for a patch.
  Index count_true(const std::vector<Run>& runs, Index nx) const {
    Index n = 0;
    for (const Run& run : runs) {
      const auto from = std::lower_bound(lift.begin(), lift.end(), run.iz * nx + run.first);
      const auto to = std::upper_bound(from, lift.end(), run.iz * nx + run.last);
      const Index length = run.last - run.first + 1;
      if (2 * (to - from) >= length) n += length;
    }
    return n;
  }
};

Plan plan_island(const ChannelMap& map, const Island& island, double jump, double allowed) {
  Plan plan;
  const Index left = std::max<Index>(0, island.left - kAround);
  const Index right = std::min(map.grid.nx - 1, island.right + kAround);
  const Index bottom = std::min(map.grid.nz - 1, island.bottom + kAround);
  const Index top = std::max<Index>(0, island.top - kAround);
  const WallAround around_box(map, top, bottom, {left, right});
  for (Index iz = top; iz <= bottom; ++iz) {
    const auto wall = around_box.row(iz);
    const bool around = iz < island.top || iz > island.bottom;
    if (!wall && around) continue;  // hidden, and none of the runs' rows
    for (Index ix = left; ix <= right; ++ix) {
      if (map.flags(iz, ix) != 0) continue;
      const Index here = iz * map.grid.nx + ix;
      const double off = wall ? map.height(iz, ix) - (*wall)[ix - left] : 0.5 * jump;
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

/// The pixels of an island that its jumps outline by themselves: a closed run on nearly every row,
/// each near the one before. None if they do not. A row between two runs takes part with the mean
/// of their ends.
std::vector<Index> outlined(const ChannelMap& map, const Island& island) {
  constexpr std::size_t kFewestRows = 5;
  constexpr Index kStep = 4;       // pixels from row to row: a disc of ten begins with as many
  constexpr Index kMostApart = 2;  // rows
  std::vector<Run> closed;
  for (const Run& run : island.runs) {
    if (!run.closed) continue;
    if (!closed.empty()) {
      const Run& before = closed.back();
      const bool goes_on = run.iz > before.iz && run.iz - before.iz <= kMostApart &&
                           std::abs(run.first - before.first) <= kStep * (run.iz - before.iz) &&
                           std::abs(run.last - before.last) <= kStep * (run.iz - before.iz);
      if (!goes_on) continue;
      if (run.iz - before.iz == 2) {
        closed.push_back({before.iz + 1, (before.first + run.first) / 2,
                          (before.last + run.last) / 2, run.order, false});
      }
    }
    closed.push_back(run);
  }
  const auto n_seen =
      std::count_if(closed.begin(), closed.end(), [](const Run& r) { return r.closed; });
  const auto n_closed = std::count_if(island.runs.begin(), island.runs.end(),
                                      [](const Run& run) { return run.closed; });
  if (closed.size() < kFewestRows || 5 * n_seen < 4 * n_closed) return {};
  std::vector<Index> pixels;
  for (const Run& run : closed) {
    for (Index ix = run.first; ix <= run.last; ++ix) {
      if (map.flags(run.iz, ix) == 0) pixels.push_back(run.iz * map.grid.nx + ix);
    }
  }
  return pixels;
}

}  // namespace

FringePatches mend_fringe_islands(ChannelMap& map, const std::vector<FringeJump>& jumps,
                                  Length noise, Length wavelength) {
  constexpr double kMostUnclear = 0.1;  // of the pixels about a patch
  FringePatches found;
  const double half = 0.5 * wavelength.si();
  for (const Island& island : join_runs(find_runs(map, jumps, half, noise.si()))) {
    const double jump = island.order * half;
    // A third of the jump keeps both kinds apart whatever the noise.
    const double allowed = std::min(half / 3.0, std::max(kWhole * half, kNoises * noise.si()));
    const Plan plan = plan_island(map, island, jump, allowed);
    const auto n_unclear = static_cast<double>(plan.flag.size());
    const auto n_clear = static_cast<double>(plan.n_wall) + static_cast<double>(plan.lift.size());
    // What a run holds must be where the jump takes it, and the rest where the wall is.
    const Index n_patch = plan.count_true(island.runs, map.grid.nx);
    if (n_patch < kFewest || n_unclear > kMostUnclear * n_clear ||
        static_cast<double>(plan.lift.size()) < 0.8 * static_cast<double>(n_patch)) {
      if (!outlined(map, island).empty()) ++found.outlined;
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

void mend_outlined_islands(ChannelMap& map, const std::vector<FringeJump>& jumps, Length noise,
                           Length wavelength, FringePatches& found) {
  const double half = 0.5 * wavelength.si();
  for (const Island& island : join_runs(find_runs(map, jumps, half, noise.si()))) {
    const std::vector<Index> pixels = outlined(map, island);
    if (pixels.empty()) continue;
    for (const Index pixel : pixels) map.height.data()[pixel] -= island.order * half;
    ++found.mended;
    found.mended_pixels += static_cast<Index>(pixels.size());
  }
}

}  // namespace manoscope::maps
