#include "manoscope/maps/fringe_jumps.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

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
  /// where it is no more than twice what the steps change by anyway, beyond `noise`.
  double jump(double noise) const {
    const auto before = side(-1, -1), behind = side(1, 1);
    if (!before && !behind) return 0.0;
    const Side a = before ? *before : *behind, b = behind ? *behind : *before;
    const auto [low, high] = std::minmax(a.slope, b.slope);
    const double jump = step(0) - std::clamp(step(0), low, high);
    const double bending = std::min(a.bending, b.bending) - noise;
    return std::abs(jump) > 2.0 * bending ? jump : 0.0;
  }

 private:
  const double* height_;
  const FlagBits* flags_;
  Index stride_, before_, behind_;
};

}  // namespace

std::vector<FringeJump> find_fringe_jumps(const ChannelMap& map, double least, double noise,
                                          Flags2& cuts) {
  const Index nz = map.grid.nz, nx = map.grid.nx;
  constexpr double kNoises = 6.0;  // of the change from step to step, 2.4 deviations of a pixel's
  std::vector<FringeJump> jumps;
  const auto look = [&](Index iz, Index ix, bool along_x) {
    const double size = Line(map, iz, ix, along_x).jump(kNoises * noise);
    if (std::abs(size) <= least) return;
    const Index here = iz * nx + ix;
    jumps.push_back({here, here + (along_x ? 1 : nx), size});
    cuts(iz, ix) |= along_x ? FlagBits{1} : FlagBits{2};
  };
  // Most steps lie near one of their neighbours': no need to look closer. Where a pixel nearby is
  // bad the plain test says nothing.
  const auto plain = [&](const double* height, const FlagBits* flags, Index stride) {
    if ((flags[-stride] | flags[2 * stride]) != 0) return false;
    const double step = height[stride] - height[0];
    const double before = height[0] - height[-stride];
    const double behind = height[2 * stride] - height[stride];
    return std::abs(step - before) <= least || std::abs(step - behind) <= least;
  };
  for (Index iz = 0; iz < nz; ++iz) {
    for (Index ix = 0; ix < nx; ++ix) {
      if (map.flags(iz, ix) != 0) continue;
      const double* height = &map.height(iz, ix);
      const FlagBits* flags = &map.flags(iz, ix);
      if (ix + 1 < nx && flags[1] == 0 && !(ix > 0 && ix + 2 < nx && plain(height, flags, 1))) {
        look(iz, ix, true);
      }
      if (iz + 1 < nz && flags[nx] == 0 && !(iz > 0 && iz + 2 < nz && plain(height, flags, nx))) {
        look(iz, ix, false);
      }
    }
  }
  return jumps;
}

}  // namespace manoscope::maps
