#include "manoscope/maps/fringe_order.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <vector>

#include "manoscope/core/flags.hpp"
#include "manoscope/maps/row_window.hpp"
#include "manoscope/numerics/robust.hpp"

namespace manoscope::maps {
namespace {

/// Pixels along one line of the map, by their place on it.
class Line {
 public:
  Line(const ChannelMap& map, Index iz, Index ix, bool along_x)
      : height_(&map.height(iz, ix)),
        flags_(&map.flags(iz, ix)),
        stride_(along_x ? 1 : map.grid.nx),
        before_(along_x ? ix : iz),
        behind_((along_x ? map.grid.nx - 1 - ix : map.grid.nz - 1 - iz)) {}

  bool good(Index k) const { return k >= -before_ && k <= behind_ && flags_[k * stride_] == 0; }
  double step(Index k) const { return height_[(k + 1) * stride_] - height_[k * stride_]; }

  /// Steps before or behind a step.
  struct Side {
    double slope;    ///< median
    double bending;  ///< largest change from step to step
  };

  /// From three steps between good neighbours at places k, k + by, ... within five; from the first
  /// if there are fewer, none if there is none.
  std::optional<Side> side(Index k, Index by) const {
    std::array<double, 3> steps{};
    std::size_t n = 0;
    for (int tried = 0; tried < 5 && n < 3; ++tried, k += by) {
      if (good(k) && good(k + 1)) steps[n++] = step(k);
    }
    if (n == 0) return std::nullopt;
    if (n < 3) return Side{steps[0], 0.0};
    const auto [low, high] = std::minmax(steps[0], steps[1]);
    return Side{std::clamp(steps[2], low, high),
                std::max(std::abs(steps[1] - steps[0]), std::abs(steps[2] - steps[1]))};
  }

  /// How far the step from here to the next pixel lies outside the steps before and behind it; 0
  /// where that is `least` or less, or no more than twice what the steps change by anyway, beyond
  /// `noise`.
  double jump(double least, double noise) const {
    const auto before = side(-1, -1);
    if (before && std::abs(step(0) - before->slope) <= least) return 0.0;
    const auto behind = side(1, 1);
    if (!before && !behind) return 0.0;
    const Side a = before ? *before : *behind, b = behind ? *behind : *before;
    const auto [low, high] = std::minmax(a.slope, b.slope);
    const double jump = step(0) - std::clamp(step(0), low, high);
    const double bending = std::min(a.bending, b.bending) - noise;
    return std::abs(jump) > std::max(least, 2.0 * bending) ? jump : 0.0;
  }

 private:
  const double* height_;
  const FlagBits* flags_;
  Index stride_, before_, behind_;
};

/// A border between two neighbouring pixels across which the height jumps.
struct Jump {
  Index from, to;  ///< pixels, row-major; `to` is the right or the lower one
  double size;     ///< m
};

/// Steps of a row to the next pixel along x and z that may be jumps: those that lie farther than
/// `least` from both the step before and the step behind, and those with a bad pixel nearby, of
/// which this says nothing. The others, nearly all, hold 0.
struct DoubtfulSteps {
  template <class Lanes>
  [[gnu::always_inline]] static void run(const RowWindow* window, Index nx, double least,
                                         double* along_x, double* along_z) {
    const double *above = window->row(-1), *here = window->row(0), *below = window->row(1);
    const double* far_below = window->row(2);
    const Lanes bound = Lanes::all(least), known = Lanes::all(0.1 * RowWindow::kAbsent);
    const auto doubtful = [&](const double* before, const double* from, const double* to,
                              const double* behind) __attribute__((always_inline)) {
      const Lanes h = Lanes::load(from), next = Lanes::load(to), step = next - h;
      const Lanes a = size_of(step - (h - Lanes::load(before)));
      const Lanes b = size_of(step - (Lanes::load(behind) - next));
      return is_below(greater(h, next), known) *
             (is_below(bound, lesser(a, b)) + is_below(known, greater(a, b)));
    };
    for (Index ix = 0; ix < nx; ix += numerics::kLanes) {
      const double* const at = here + ix;
      doubtful(at - 1, at, at + 1, at + 2).store(along_x + ix);
      doubtful(above + ix, at, below + ix, far_below + ix).store(along_z + ix);
    }
  }
};

/// Jumps between good neighbours along x and z, and for each pixel whether one parts it from the
/// right (1) or the lower neighbour (2).
std::vector<Jump> find_jumps(const ChannelMap& map, double least, double noise, Flags2& cuts) {
  const Index nz = map.grid.nz, nx = map.grid.nx;
  constexpr double kNoises = 6.0;  // of the change from step to step, 2.4 deviations of a pixel's
  std::vector<Jump> jumps;
  const auto look = [&](Index iz, Index ix, bool along_x) {
    const double size = Line(map, iz, ix, along_x).jump(least, kNoises * noise);
    if (size == 0.0) return;
    const Index here = iz * nx + ix;
    jumps.push_back({here, here + (along_x ? 1 : nx), size});
    cuts(iz, ix) |= along_x ? FlagBits{1} : FlagBits{2};
  };
  RowWindow window(map);
  const auto n_filled = static_cast<std::size_t>(nx + numerics::kLanes);
  std::vector<double> along_x(n_filled), along_z(n_filled);
  for (Index iz = 0; iz < nz; ++iz) {
    window.move_to(iz);
    numerics::run_in_lanes<DoubtfulSteps>(numerics::best_instructions(), &window, nx, least,
                                          along_x.data(), along_z.data());
    for (Index ix = 0; ix < nx; ++ix) {
      const auto at = static_cast<std::size_t>(ix);
      if (along_x[at] + along_z[at] == 0.0) continue;
      if (along_x[at] != 0.0) look(iz, ix, true);
      if (along_z[at] != 0.0) look(iz, ix, false);
    }
  }
  return jumps;
}

/// Whether enough jumps lie side by side to part a patch from the rest: noise makes lone ones.
bool may_close(const std::vector<Jump>& jumps, const Flags2& cuts) {
  constexpr Index kReach = 2;
  constexpr int kFewest = 6;
  int beside = 0;
  for (const Jump& jump : jumps) {
    const Index iz = jump.from / cuts.cols(), ix = jump.from % cuts.cols();
    const Index top = std::max<Index>(0, iz - kReach), left = std::max<Index>(0, ix - kReach);
    const auto around = cuts.block(top, left, std::min(cuts.rows(), iz + kReach + 1) - top,
                                   std::min(cuts.cols(), ix + kReach + 1) - left);
    if ((around != 0).count() > 1) ++beside;
    if (beside >= kFewest) return true;
  }
  return false;
}

/// Patches of good pixels between which every step is a jump.
class Patches {
 public:
  Patches(const ChannelMap& map, const Flags2& cuts)
      : parent_(static_cast<std::size_t>(map.flags.size())) {
    const Index nz = map.grid.nz, nx = map.grid.nx;
    for (Index iz = 0; iz < nz; ++iz) {
      for (Index ix = 0; ix < nx; ++ix) {
        const Index here = iz * nx + ix;
        parent_[static_cast<std::size_t>(here)] = here;
        if (map.flags(iz, ix) != 0) continue;
        if (ix > 0 && map.flags(iz, ix - 1) == 0 && (cuts(iz, ix - 1) & 1) == 0) {
          join(here - 1, here);
        }
        if (iz > 0 && map.flags(iz - 1, ix) == 0 && (cuts(iz - 1, ix) & 2) == 0) {
          join(here - nx, here);
        }
      }
    }
    for (Index i = 0; i < map.flags.size(); ++i) {
      if (map.flags.data()[i] == 0) ++size_[root(i)];
    }
  }

  /// The patch of a pixel: its first pixel.
  Index root(Index pixel) const {
    while (parent_[static_cast<std::size_t>(pixel)] != pixel) {
      pixel = parent_[static_cast<std::size_t>(pixel)];
    }
    return pixel;
  }
  const std::map<Index, Index>& sizes() const { return size_; }

 private:
  void join(Index a, Index b) {
    a = root(a), b = root(b);
    if (a == b) return;
    parent_[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
  }
  std::vector<Index> parent_;
  std::map<Index, Index> size_;
};

/// The jumps into one patch from settled ones: minus what it must be lifted by.
struct Border {
  std::vector<double> jumps;

  /// Mean of the jumps near their median, `allowed` or the share `relative` of it away; none if
  /// fewer than four of five are.
  std::optional<double> agreed(double relative, double allowed) const {
    std::vector<double> ordered = jumps;
    const double middle = numerics::median(ordered);
    allowed = std::max(allowed, relative * std::abs(middle));
    double n = 0.0, sum = 0.0;
    for (const double jump : jumps) {
      if (std::abs(jump - middle) > allowed) continue;
      n += 1.0;
      sum += jump;
    }
    if (n < 0.8 * static_cast<double>(jumps.size())) return std::nullopt;
    return sum / n;
  }
};

}  // namespace

FringePatches mend_fringe_patches(ChannelMap& map, Length noise, std::optional<Length> wavelength) {
  constexpr Index kSmallest = 4;    // pixels
  constexpr double kLeast = 50e-9;  // m, without a wavelength
  constexpr double kNoises = 5.0;   // spread of a border's jumps, in deviations of the noise,
  constexpr double kAgree = 0.15;   // or as a share of them
  constexpr double kWhole = 0.15;   // distance from a whole number of half wavelengths
  FringePatches found;
  const double sigma = noise.si();
  if (wavelength && sigma > 0.125 * wavelength->si()) return found;
  const double least = wavelength ? 0.25 * wavelength->si() : std::max(kLeast, 8.0 * sigma);
  Flags2 cuts = Flags2::Zero(map.grid.nz, map.grid.nx);
  const std::vector<Jump> jumps = find_jumps(map, least, sigma, cuts);
  if (!may_close(jumps, cuts)) return found;

  const Patches patches(map, cuts);
  const auto larger = [](const auto& a, const auto& b) { return a.second < b.second; };
  const auto main = std::max_element(patches.sizes().begin(), patches.sizes().end(), larger);
  std::map<Index, double> lift{{main->first, 0.0}};  // of settled patches
  std::map<Index, bool> bad;
  struct Link {
    Index from, to;
    double size;
  };
  std::vector<Link> links;
  for (const Jump& jump : jumps) {
    const Index from = patches.root(jump.from), to = patches.root(jump.to);
    if (from != to) links.push_back({from, to, jump.size});
  }
  while (!links.empty()) {
    std::map<Index, Border> borders;
    for (const Link& link : links) {
      const bool from_settled = lift.contains(link.from), to_settled = lift.contains(link.to);
      if (from_settled && !to_settled)
        borders[link.to].jumps.push_back(link.size - lift.at(link.from));
      if (to_settled && !from_settled)
        borders[link.from].jumps.push_back(-link.size - lift.at(link.to));
    }
    if (borders.empty()) break;  // islands among missing pixels
    const auto next = std::max_element(
        borders.begin(), borders.end(),
        [](const auto& a, const auto& b) { return a.second.jumps.size() < b.second.jumps.size(); });
    const auto jump = next->second.agreed(kAgree, kNoises * sigma);
    bool plain = jump && patches.sizes().at(next->first) >= kSmallest;
    double by = -jump.value_or(0.0);
    if (wavelength) {
      const double half = 0.5 * wavelength->si(), order = std::round(by / half);
      plain = plain && std::abs(by / half - order) <= kWhole;
      by = order * half;
    }
    lift[next->first] = by;
    bad[next->first] = !plain;
    std::erase_if(links, [&](const Link& link) {
      return lift.contains(link.from) && lift.contains(link.to);
    });
  }

  for (Index i = 0; i < map.flags.size(); ++i) {
    if (map.flags.data()[i] != 0) continue;
    const auto patch = bad.find(patches.root(i));
    if (patch == bad.end()) continue;
    if (patch->second) {
      map.flags.data()[i] |= PixelFlag::fringe_order;
      ++found.flagged_pixels;
    } else {
      map.height.data()[i] += lift.at(patch->first);
      ++found.mended_pixels;
    }
  }
  for (const auto& [patch, is_bad] : bad) ++(is_bad ? found.flagged : found.mended);
  return found;
}

}  // namespace manoscope::maps
