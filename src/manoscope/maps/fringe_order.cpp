#include "manoscope/maps/fringe_order.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "manoscope/core/flags.hpp"
#include "manoscope/maps/fringe_islands.hpp"
#include "manoscope/maps/fringe_jumps.hpp"
#include "manoscope/numerics/robust.hpp"

namespace manoscope::maps {
namespace {

/// Whether enough jumps lie side by side to part a patch from the rest: noise makes lone ones.
bool may_close(const std::vector<FringeJump>& jumps, const Flags2& cuts) {
  constexpr Index kReach = 2;
  constexpr int kFewest = 6;
  int beside = 0;
  for (const FringeJump& jump : jumps) {
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
  std::vector<FringeJump> jumps = find_fringe_jumps(map, least, sigma, cuts);
  if (!may_close(jumps, cuts)) return found;
  if (wavelength) {
    found = mend_fringe_islands(map, jumps, noise, *wavelength);
    if (found.mended > 0) {
      cuts.setZero();
      jumps = find_fringe_jumps(map, least, sigma, cuts);
      if (!may_close(jumps, cuts)) return found;
    }
  }

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
  for (const FringeJump& jump : jumps) {
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
  if (found.outlined > 0) {
    cuts.setZero();
    jumps = find_fringe_jumps(map, least, sigma, cuts);
    mend_outlined_islands(map, jumps, noise, *wavelength, found);
  }
  return found;
}

}  // namespace manoscope::maps
