#include "manoscope/calibration/levels.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "manoscope/core/error.hpp"
#include "manoscope/core/flags.hpp"

namespace manoscope::calibration {
namespace {

/// Mean of levels [first, last) that share one pressure.
Level merge(const std::vector<Level>& levels, std::size_t first, std::size_t last) {
  Level merged = levels[first];
  const auto n = static_cast<double>(last - first);
  std::vector<Profile> profiles;
  double variance = 0.0, gauge_share = 0.0;
  for (std::size_t k = first; k < last; ++k) {
    profiles.push_back(levels[k].profile);
    variance += levels[k].uncertainty.si() * levels[k].uncertainty.si();
    gauge_share += levels[k].gauge_share;
    if (k > first) merged.name += " + " + levels[k].name;
  }
  merged.profile = mean_profile(profiles);
  merged.uncertainty = Pressure::from_si(std::sqrt(variance) / n);
  merged.gauge_share = gauge_share / n;
  return merged;
}

}  // namespace

std::vector<Level> order_levels(std::vector<Level> levels) {
  std::stable_sort(levels.begin(), levels.end(), [](const Level& a, const Level& b) {
    return a.pressure != b.pressure ? a.pressure < b.pressure : a.name < b.name;
  });
  for (const Level& level : levels) {
    const bool same = level.profile.x.size() == levels.front().profile.x.size() &&
                      (level.profile.x == levels.front().profile.x).all();
    if (!same) {
      throw InputError(level.name, "has other stations along x than " + levels.front().name,
                       "Take all maps of one experiment with the same camera settings");
    }
  }
  return levels;
}

std::vector<Level> sort_levels(std::vector<Level> levels) {
  levels = order_levels(std::move(levels));
  std::vector<Level> result;
  for (std::size_t first = 0; first < levels.size();) {
    std::size_t last = first + 1;
    while (last < levels.size() && levels[last].pressure == levels[first].pressure) ++last;
    result.push_back(merge(levels, first, last));
    first = last;
  }
  constexpr std::size_t kFewest = 3;
  if (result.size() < kFewest) {
    throw InputError("calibration", fmt::format("has {} distinct pressures", result.size()),
                     "Give maps at 3 known pressures or more");
  }
  return result;
}

}  // namespace manoscope::calibration
