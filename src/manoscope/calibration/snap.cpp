#include "manoscope/calibration/snap.hpp"

#include <algorithm>
#include <cmath>

namespace manoscope::calibration {
namespace {

/// Levels that their labels do not tell apart, as one.
struct Group {
  Index first;
  double pressure, state, doubt;  ///< Pa, m, Pa
};

/// The state of a level is the mean over the stations that count in all, weighted by the whole
/// change.
std::vector<Group> group(const std::vector<Level>& levels) {
  constexpr double kApart = 3.0;   // standard uncertainties
  constexpr double kLeast = 1e-4;  // of the range of pressures
  Array1 weight = levels.back().profile.zeta - levels.front().profile.zeta;
  for (const Level& level : levels) {
    for (Index ix = 0; ix < weight.size(); ++ix) {
      if (level.profile.flags[ix] != 0) weight[ix] = 0.0;
    }
  }
  const double least = kLeast * (levels.back().pressure - levels.front().pressure).si();
  std::vector<Group> groups;
  std::vector<double> counts;
  for (std::size_t k = 0; k < levels.size(); ++k) {
    const Level& level = levels[k];
    const double state = (weight * level.profile.zeta).sum(), pressure = level.pressure.si();
    const double doubt = level.uncertainty.si();
    if (!groups.empty() && pressure - groups.back().pressure <
                               std::max(kApart * std::hypot(doubt, groups.back().doubt), least)) {
      Group& last = groups.back();
      const double n = counts.back()++;
      last.pressure = (n * last.pressure + pressure) / (n + 1.0);
      last.state = (n * last.state + state) / (n + 1.0);
      continue;
    }
    groups.push_back({static_cast<Index>(k), pressure, state, doubt});
    counts.push_back(1.0);
  }
  return groups;
}

}  // namespace

std::optional<Index> level_after_snap(const std::vector<Level>& levels) {
  constexpr double kSteeper = 8.0;
  const auto lower = [](const Level& a, const Level& b) { return a.pressure < b.pressure; };
  if (levels.empty() || !std::is_sorted(levels.begin(), levels.end(), lower)) return std::nullopt;
  const std::vector<Group> groups = group(levels);
  const auto n = static_cast<Index>(groups.size());
  const auto rise = [&](Index k) {
    const Group &low = groups[static_cast<std::size_t>(k)],
                &high = groups[static_cast<std::size_t>(k + 1)];
    return std::abs(high.state - low.state) / (high.pressure - low.pressure);
  };
  for (Index k = n - 3; k >= 0; --k) {
    const double beside = std::max(rise(k + 1), k > 0 ? rise(k - 1) : 0.0);
    if (rise(k) > kSteeper * beside) return groups[static_cast<std::size_t>(k + 1)].first;
  }
  return std::nullopt;
}

}  // namespace manoscope::calibration
