#include "manoscope/inversion/sweeps.hpp"

#include <cmath>
#include <map>
#include <set>
#include <string>

#include "manoscope/inversion/read_pressure.hpp"
#include "manoscope/inversion/thinned.hpp"

namespace manoscope::inversion {
namespace {

using calibration::Level;

/// Levels by the way on which they were reached.
struct Ways {
  std::vector<Level> up, down;
};

Ways split(const std::vector<Level>& levels, const std::vector<Index>& stations) {
  Ways ways;
  for (std::size_t k = 0; k < levels.size(); ++k) {
    Level level = levels[k];
    level.profile = thinned(level.profile, stations);
    const bool fell = k > 0 && levels[k].pressure < levels[k - 1].pressure;
    (fell ? ways.down : ways.up).push_back(std::move(level));
  }
  return ways;
}

std::size_t count_pressures(const std::vector<Level>& levels) {
  std::set<double> pressures;
  for (const Level& level : levels) pressures.insert(level.pressure.si());
  return pressures.size();
}

/// Sum of the differences of many maps, and of the errors that they share.
class Sum {
 public:
  /// Minus the mean of a reading; false where fewer than half of the stations have an answer.
  bool add(const Level& level, const PressureReading& reading) {
    Array1 weight = Array1::Zero(reading.x.size());
    for (Index i = 0; i < weight.size(); ++i) weight[i] = reading.answered(i) ? 1.0 : 0.0;
    if (2.0 * weight.sum() < static_cast<double>(weight.size())) return false;
    weight /= weight.sum();
    ++n_;
    difference_ += level.pressure.si() - (weight * reading.pressure).sum();
    variance_ += std::pow(level.uncertainty.si(), 2) +
                 (weight * reading.uncertainty.independent).square().sum();
    for (const ErrorMode& mode : reading.uncertainty.modes) {
      shared_[mode.variable] += (weight * mode.effect).sum();
    }
    return true;
  }
  int count() const { return n_; }
  double mean() const { return difference_ / n_; }
  double uncertainty() const {
    double variance = variance_;
    for (const auto& [variable, effect] : shared_) variance += effect * effect;
    return std::sqrt(variance) / n_;
  }

 private:
  int n_ = 0;
  double difference_ = 0.0, variance_ = 0.0;
  std::map<std::string, double> shared_;
};

}  // namespace

std::optional<SweepComparison> compare_sweeps(const std::vector<Level>& levels,
                                              const calibration::FitCurvesOptions& options,
                                              const Stretch& stretch) {
  constexpr Index kStations = 30;
  constexpr std::size_t kFewestUp = 4;
  constexpr int kFewestDown = 3;
  if (levels.empty()) return std::nullopt;
  const auto stations = some_stations(levels.front().profile.x, stretch, kStations);
  if (stations.size() < 2) return std::nullopt;
  const Ways ways = split(levels, stations);
  if (count_pressures(ways.up) < kFewestUp) return std::nullopt;
  const calibration::ConstitutiveCurves curves = calibration::fit_curves(ways.up, options);
  Sum sum;
  for (const Level& level : ways.down) sum.add(level, read_pressure(curves, level.profile));
  if (sum.count() < kFewestDown) return std::nullopt;
  return SweepComparison{static_cast<int>(ways.up.size()), sum.count(), sum.mean(),
                         sum.uncertainty()};
}

}  // namespace manoscope::inversion
