#include "manoscope/design/place_levels.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "manoscope/core/error.hpp"
#include "manoscope/core/parallel.hpp"

namespace manoscope::design {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

/// Pressures at which a set of levels is judged: three between each two of them, and both ends.
Array1 judged_pressures(const std::vector<double>& levels, const PressureSpan& range) {
  std::vector<double> found{range.low};
  for (std::size_t k = 1; k < levels.size(); ++k) {
    const double low = std::max(levels[k - 1], range.low), high = std::min(levels[k], range.high);
    if (!(high > low)) continue;
    for (const double share : {1.0 / 6.0, 0.5, 5.0 / 6.0}) {
      found.push_back(low + share * (high - low));
    }
  }
  found.push_back(range.high);
  return Eigen::Map<const Array1>(found.data(), static_cast<Index>(found.size()));
}

/// Root of the weighted mean of squares, by trapezoids.
double weighted_rms(const Array1& pressure, const Array1& variance, const Target& target) {
  double sum = 0.0, weights = 0.0;
  for (Index i = 1; i < pressure.size(); ++i) {
    const double middle = 0.5 * (pressure[i] + pressure[i - 1]);
    const double weight = target.density(middle) * (pressure[i] - pressure[i - 1]);
    sum += 0.5 * weight * (variance[i] + variance[i - 1]);
    weights += weight;
  }
  return std::sqrt(sum / weights);
}

/// One number for the uncertainties of a forecast, Pa.
double summarise(const Forecast& forecast, const Target& target, Aim aim) {
  const Array1 variance = forecast.uncertainty().square();
  if (!variance.isFinite().all()) return kInfinite;
  // A mean of high power: the largest counts, and those next to it are not forgotten.
  constexpr double kPower = 8.0, kShare = 0.1;
  const double largest = variance.maxCoeff();
  const double worst = largest * std::pow((variance / largest).pow(kPower).mean(), 1.0 / kPower);
  if (aim == Aim::worst) return std::sqrt(worst);
  const double rms = weighted_rms(forecast.pressure, variance, target);
  return std::sqrt((1.0 - kShare) * rms * rms + kShare * worst);
}

/// The walls that a plan is made for.
std::vector<Apparatus> possible_apparatuses(const PlacementTask& task) {
  std::vector<Apparatus> apparatuses{task.apparatus};
  if (!(task.wall_doubt > 0.0)) return apparatuses;
  for (const double factor : {1.0 - task.wall_doubt, 1.0 + task.wall_doubt}) {
    apparatuses.push_back(task.apparatus);
    apparatuses.back().curve = task.apparatus.curve.scaled(factor);
  }
  return apparatuses;
}

double score_apparatuses(const PlacementTask& task, const std::vector<Apparatus>& apparatuses,
                         const std::vector<double>& levels) {
  constexpr std::size_t kFewest = 3;  // what a calibration wants
  if (std::set<double>(levels.begin(), levels.end()).size() < kFewest) return kInfinite;
  const Array1 pressures = judged_pressures(levels, task.target.range);
  double squares = 0.0;
  for (const Apparatus& apparatus : apparatuses) {
    const double one =
        summarise(forecast_readings(apparatus, levels, pressures), task.target, task.aim);
    squares += one * one;
  }
  return std::sqrt(squares / static_cast<double>(apparatuses.size()));
}

using Levels = std::vector<double>;

/// In which levels move: half pressure, half deflection, from 0 to 1 at the highest level.
class Coordinate {
 public:
  explicit Coordinate(const PlacementTask& task)
      : curve_(task.apparatus.curve), top_(task.highest_level), rest_(curve_.deflection(0.0)) {
    rise_ = curve_.deflection(top_) - rest_;
  }
  double of(double pressure) const {
    return 0.5 * (pressure / top_ + (curve_.deflection(pressure) - rest_) / rise_);
  }
  double pressure(double wanted) const {
    double low = 0.0, high = top_;
    for (int i = 0; i < 50; ++i) {
      const double middle = 0.5 * (low + high);
      (of(middle) < wanted ? low : high) = middle;
    }
    return 0.5 * (low + high);
  }
  /// n levels, even in it.
  Levels even(int n, double first, double last) const {
    Levels levels;
    const double from = of(first), to = of(last);
    for (int k = 0; k < n; ++k) levels.push_back(pressure(from + (to - from) * k / (n - 1)));
    levels.front() = first;
    levels.back() = last;
    return levels;
  }

 private:
  const WallCurve& curve_;
  double top_, rest_, rise_ = 1.0;
};

class Placer {
 public:
  Placer(const PlacementTask& task, int n_threads, const Monitor& monitor)
      : task_(task),
        apparatuses_(possible_apparatuses(task)),
        n_threads_(n_threads),
        monitor_(monitor),
        at_(task),
        first_(task.vented ? 1 : 0) {}

  Levels run(int n) {
    best_ = start(n);
    least_ = score(best_);
    floor_ = score_floor(task_, best_);
    exchange(2 * n);
    const double first_step = 0.5 / n;
    for (double step = first_step; step > 0.04 * first_step; step *= 0.5) {
      for (int sweep = 0; sweep < kSweeps && sweep_levels(step); ++sweep) {
      }
      exchange(kExchanges);
    }
    return best_;
  }

 private:
  static constexpr int kSweeps = 3, kExchanges = 3;
  static constexpr double kGain = 1e-3, kExchangeGain = 3e-3;  // below that nothing is gained
  static constexpr double kApart = 0.5;                        // of the mean distance

  /// Crowded levels are dear, not forbidden: what a start has of them can be moved away.
  double score(const Levels& levels) const {
    constexpr double kPrice = 0.5;
    return score_apparatuses(task_, apparatuses_, levels) * (1.0 + kPrice * crowding(levels));
  }
  /// By how much more levels than may be lie within a share of their mean distance, in sum.
  double crowding(const Levels& levels) const {
    const double apart = kApart / static_cast<double>(levels.size());
    const auto more = static_cast<std::size_t>(task_.most_repeats);
    double sum = 0.0;
    for (std::size_t k = 0; k + more < levels.size(); ++k) {
      const double distance = at_.of(levels[k + more]) - at_.of(levels[k]);
      sum += std::max(0.0, 1.0 - distance / apart);
    }
    return sum;
  }

  Levels start(int n) const {
    const double first = task_.vented ? 0.0 : task_.target.range.low;
    return least_of({even_levels(n, first, task_.lowest_top, task_.vented),
                     best_log_spaced(task_, n), at_.even(n, first, task_.lowest_top)});
  }

  /// The first of those with the lowest score.
  Levels least_of(const std::vector<Levels>& candidates) const {
    std::vector<double> scores(candidates.size(), kInfinite);
    parallel_for(static_cast<Index>(candidates.size()), n_threads_, [&](Index i) {
      monitor_.checkpoint();
      const auto at = static_cast<std::size_t>(i);
      scores[at] = score(candidates[at]);
    });
    const auto least = std::min_element(scores.begin(), scores.end());
    return candidates[static_cast<std::size_t>(least - scores.begin())];
  }

  bool accept(Levels levels, double gain) {
    monitor_.checkpoint();
    std::sort(levels.begin(), levels.end());
    if (levels.back() < task_.lowest_top) return false;
    const double value = score(levels);
    if (!(value - floor_ < (1.0 - gain) * (least_ - floor_))) return false;
    least_ = value;
    best_ = std::move(levels);
    return true;
  }

  bool sweep_levels(double step) {
    bool moved = false;
    for (std::size_t k = first_; k < best_.size(); ++k) {
      for (const double way : {-1.0, 1.0}) {
        Levels levels = best_;
        const double at = at_.of(levels[k]) + way * step;
        levels[k] = std::clamp(at_.pressure(at), 0.0, task_.highest_level);
        if (levels[k] <= task_.apparatus.gauge.noise.si()) continue;
        if (!accept(std::move(levels), kGain)) continue;
        moved = true;
        break;
      }
    }
    return moved;
  }

  /// Moves the level that helps least to where it helps most, as long as that gains.
  void exchange(int most) {
    for (int i = 0; i < most; ++i) {
      std::vector<Levels> fewer;
      for (std::size_t k = first_; k + 1 < best_.size(); ++k) {
        fewer.push_back(best_);
        fewer.back().erase(fewer.back().begin() + static_cast<Index>(k));
      }
      if (!accept(with_one_more(least_of(fewer)), kExchangeGain)) return;
    }
  }

  /// One more level where it helps most: upon another or half-way between two.
  Levels with_one_more(const Levels& levels) const {
    std::vector<double> places;
    for (std::size_t k = 0; k < levels.size(); ++k) {
      if (levels[k] > 0.0) places.push_back(levels[k]);
      const bool last = k + 1 == levels.size();
      if (last || levels[k + 1] - levels[k] < task_.apparatus.gauge.noise.si()) continue;
      places.push_back(at_.pressure(0.5 * (at_.of(levels[k]) + at_.of(levels[k + 1]))));
    }
    std::vector<Levels> candidates;
    for (const double place : places) {
      candidates.push_back(levels);
      Levels& more = candidates.back();
      more.insert(std::upper_bound(more.begin(), more.end(), place), place);
    }
    return least_of(candidates);
  }

  const PlacementTask& task_;
  std::vector<Apparatus> apparatuses_;
  int n_threads_;
  const Monitor& monitor_;
  Coordinate at_;
  std::size_t first_;  ///< level that may move
  Levels best_;
  double least_ = kInfinite, floor_ = 0.0;
};

}  // namespace

double score_levels(const PlacementTask& task, const std::vector<double>& levels) {
  return score_apparatuses(task, possible_apparatuses(task), levels);
}

double Target::density(double pressure) const {
  const auto of = [&](const PressureSpan& span) {
    const bool inside = pressure >= span.low && pressure <= span.high;
    return inside ? 1.0 / (span.high - span.low) : 0.0;
  };
  if (spans.empty()) return of(range);
  double sum = 0.0;
  for (const PressureSpan& span : spans) sum += of(span);
  return sum / static_cast<double>(spans.size());
}

RangeUncertainty uncertainty_over(const Apparatus& apparatus, const std::vector<double>& levels,
                                  const Target& target) {
  constexpr Index kSteps = 300;
  const Forecast forecast = forecast_readings(
      apparatus, levels, Array1::LinSpaced(kSteps + 1, target.range.low, target.range.high));
  const Array1 uncertainty = forecast.uncertainty(), error = forecast.error.standard();
  RangeUncertainty over;
  Index worst = 0;
  over.worst = uncertainty.maxCoeff(&worst);
  over.worst_at = forecast.pressure[worst];
  over.rms = over.rms_error = kInfinite;
  if (!std::isfinite(over.worst)) return over;
  over.rms = weighted_rms(forecast.pressure, uncertainty.square(), target);
  over.rms_error = weighted_rms(forecast.pressure, error.square(), target);
  return over;
}

std::vector<double> log_spaced(int n, double first, double top, bool vented) {
  std::vector<double> levels;
  if (vented) levels.push_back(0.0);
  const int n_ratios = n - static_cast<int>(levels.size()) - 1;
  for (int k = 0; k <= n_ratios; ++k) {
    levels.push_back(first * std::pow(top / first, static_cast<double>(k) / n_ratios));
  }
  levels.back() = top;
  return levels;
}

std::vector<double> even_levels(int n, double first, double top, bool vented) {
  std::vector<double> levels;
  const double from = vented ? 0.0 : first;
  for (int k = 0; k < n; ++k) levels.push_back(from + (top - from) * k / (n - 1));
  levels.back() = top;
  return levels;
}

std::vector<double> best_log_spaced(const PlacementTask& task, int n) {
  std::vector<double> best;
  double least = kInfinite;
  const double least_ratio = task.vented ? 1.5 : 1.01;
  for (double first = task.lowest_top / least_ratio; first > 1e-3 * task.lowest_top; first /= 1.5) {
    if (!task.vented && first > task.target.range.low) continue;
    auto levels = log_spaced(n, first, task.lowest_top, task.vented);
    const double value = score_apparatuses(task, {task.apparatus}, levels);
    if (!best.empty() && !(value < least)) continue;
    least = value;
    best = std::move(levels);
  }
  return best;
}

std::vector<double> dense_levels(const PlacementTask& task) {
  constexpr int kMany = 60;
  const double first = task.vented ? 0.0 : task.target.range.low;
  return Coordinate(task).even(kMany, first, task.highest_level);
}

Apparatus with_exact_labels(const Apparatus& apparatus) {
  Apparatus exact = apparatus;
  exact.gauge.noise = Pressure{};
  return exact;
}

double score_floor(const PlacementTask& task, const std::vector<double>& levels) {
  constexpr double kBelow = 0.99;
  PlacementTask exact = task;
  exact.apparatus = with_exact_labels(task.apparatus);
  return std::min(score_levels(exact, dense_levels(task)), kBelow * score_levels(task, levels));
}

std::vector<double> place_levels(const PlacementTask& task, int n, int n_threads,
                                 const Monitor& monitor) {
  MANO_ASSERT(n >= 4 && task.highest_level >= task.lowest_top);
  return Placer(task, n_threads, monitor).run(n);
}

}  // namespace manoscope::design
