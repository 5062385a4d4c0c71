#include "manoscope/calibration/snap.hpp"

#include <algorithm>
#include <cmath>

namespace manoscope::calibration {
namespace {

/// Mean over the stations that count in all levels, weighted by the whole change.
Array1 states(const std::vector<Level>& levels) {
  Array1 weight = levels.back().profile.zeta - levels.front().profile.zeta;
  for (const Level& level : levels) {
    for (Index ix = 0; ix < weight.size(); ++ix) {
      if (level.profile.flags[ix] != 0) weight[ix] = 0.0;
    }
  }
  Array1 result(static_cast<Index>(levels.size()));
  for (std::size_t k = 0; k < levels.size(); ++k) {
    result[static_cast<Index>(k)] = (weight * levels[k].profile.zeta).sum();
  }
  return result;
}

}  // namespace

std::optional<Index> level_after_snap(const std::vector<Level>& levels) {
  constexpr double kSteeper = 8.0;
  const auto n = static_cast<Index>(levels.size());
  if (n < 4) return std::nullopt;
  const Array1 state = states(levels);
  // Labels that noise has brought together make no step steep.
  const double least = 1e-4 * (levels.back().pressure - levels.front().pressure).si();
  const auto rise = [&](Index k) {
    const auto at = static_cast<std::size_t>(k);
    const double step = (levels[at + 1].pressure - levels[at].pressure).si();
    const double doubt = std::hypot(levels[at + 1].uncertainty.si(), levels[at].uncertainty.si());
    return std::abs(state[k + 1] - state[k]) / std::max({step, doubt, least});
  };
  for (Index k = n - 3; k >= 0; --k) {
    const double beside = std::max(rise(k + 1), k > 0 ? rise(k - 1) : 0.0);
    if (rise(k) > kSteeper * beside && beside > 0.0) return k + 1;
  }
  return std::nullopt;
}

}  // namespace manoscope::calibration
