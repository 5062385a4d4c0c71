#include "manoscope/maps/fringe_jumps.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "manoscope/maps/row_window.hpp"

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

}  // namespace

std::vector<FringeJump> find_fringe_jumps(const ChannelMap& map, double least, double noise,
                                          Flags2& cuts) {
  const Index nz = map.grid.nz, nx = map.grid.nx;
  constexpr double kNoises = 6.0;  // of the change from step to step, 2.4 deviations of a pixel's
  std::vector<FringeJump> jumps;
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

}  // namespace manoscope::maps
