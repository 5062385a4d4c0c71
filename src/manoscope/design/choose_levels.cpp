#include "manoscope/design/choose_levels.hpp"

#include <algorithm>
#include <cmath>

namespace manoscope::design {
namespace {

using Levels = std::vector<double>;

constexpr double kPrice = 1.01;  // of tidiness
constexpr int kFewest = 5;

/// Runs of levels that span less than `reach`, each level moved to the run's mean; a run has no
/// more than `most` of them.
Levels merged(const Levels& levels, double reach, std::size_t most) {
  Levels result;
  for (std::size_t first = 0; first < levels.size();) {
    std::size_t last = first + 1;
    // What is vented is no reading of the gauge.
    while (levels[first] > 0.0 && last < levels.size() && last - first < most &&
           levels[last] - levels[first] < reach) {
      ++last;
    }
    double sum = 0.0;
    for (std::size_t k = first; k < last; ++k) sum += levels[k];
    result.insert(result.end(), last - first, sum / static_cast<double>(last - first));
    first = last;
  }
  return result;
}

int largest_repeats(const Levels& levels) {
  int largest = 0;
  for (const PlannedLevel& level : count_repeats(levels)) {
    largest = std::max(largest, level.repeats);
  }
  return largest;
}

/// The largest 1, 2 or 5 times a power of ten that is not above.
double round_step(double above) {
  const double power = std::pow(10.0, std::floor(std::log10(above)));
  for (const double digit : {5.0, 2.0}) {
    if (digit * power <= above) return digit * power;
  }
  return power;
}

/// Every level rounded to a share of its distance to the next ones, the last not below lowest_top.
Levels rounded(const PlacementTask& task, const Levels& levels, double share) {
  Levels result = levels;
  for (std::size_t k = 0; k < levels.size(); ++k) {
    double gap = 0.0;
    for (const double other : levels) {
      const double distance = std::abs(other - levels[k]);
      if (distance > 0.0 && (gap == 0.0 || distance < gap)) gap = distance;
    }
    if (gap == 0.0) continue;
    const double step = round_step(share * gap);
    double nearest = step * std::round(levels[k] / step);
    if (k + 1 == levels.size() && nearest < task.lowest_top) nearest += step;
    if (nearest > task.highest_level) nearest -= step;
    result[k] = nearest < task.lowest_top && k + 1 == levels.size() ? levels[k] : nearest;
  }
  return result;
}

}  // namespace

std::vector<PlannedLevel> count_repeats(const std::vector<double>& levels) {
  std::vector<PlannedLevel> counted;
  for (const double level : levels) {
    if (!counted.empty() && counted.back().pressure == level) {
      ++counted.back().repeats;
    } else {
      counted.push_back({level, 1});
    }
  }
  return counted;
}

std::vector<double> tidy_levels(const PlacementTask& task, const std::vector<double>& levels) {
  const double score = score_levels(task, levels), floor = score_floor(task, levels);
  const double allowed = floor + kPrice * (score - floor);
  Levels tidy = levels;
  const double noise = task.apparatus.gauge.noise.si();
  for (const double reach : {4.0, 3.0, 2.0, 1.0, 0.5}) {
    Levels candidate = merged(levels, reach * noise, static_cast<std::size_t>(task.most_repeats));
    if (candidate.back() < task.lowest_top || score_levels(task, candidate) > allowed) continue;
    tidy = std::move(candidate);
    break;
  }
  for (const double share : {0.5, 0.2, 0.1, 0.05, 0.02}) {
    Levels candidate = rounded(task, tidy, share);
    std::sort(candidate.begin(), candidate.end());
    if (largest_repeats(candidate) > task.most_repeats) continue;
    if (score_levels(task, candidate) <= floor + kPrice * (allowed - floor)) return candidate;
  }
  return tidy;
}

ChosenLevels fewest_levels(const PlacementTask& task, int most,
                           const std::function<bool(const std::vector<double>&)>& enough,
                           int n_threads, const Monitor& monitor) {
  constexpr double kGrowth = 1.35;
  const auto place = [&](int n) {
    monitor.report("placing levels", static_cast<double>(n) / most);
    Levels tidy = tidy_levels(task, place_levels(task, n, n_threads, monitor));
    const bool does = enough(tidy);
    return ChosenLevels{std::move(tidy), does};
  };
  int low = kFewest - 1, high = std::min(kFewest, most);
  ChosenLevels chosen = place(high);
  while (!chosen.enough && high < most) {
    low = high;
    high = std::min(most, static_cast<int>(std::ceil(kGrowth * high)));
    chosen = place(high);
  }
  while (chosen.enough && high - low > 1) {
    const int middle = (low + high) / 2;
    ChosenLevels fewer = place(middle);
    (fewer.enough ? high : low) = middle;
    if (fewer.enough) chosen = std::move(fewer);
  }
  return chosen;
}

}  // namespace manoscope::design
