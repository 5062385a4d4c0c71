#include "manoscope/inversion/leave_one_out.hpp"

#include <cmath>
#include <limits>

#include "manoscope/inversion/read_pressure.hpp"
#include "manoscope/inversion/thinned.hpp"

namespace manoscope::inversion {
namespace {

using calibration::Level;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

LevelLeftOut no_numbers(Index n) {
  return {Array1::Constant(n, kNan), Array1::Constant(n, kNan), kNan, kNan};
}

LevelLeftOut compare(const Level& level, const PressureReading& reading) {
  const Index n = reading.x.size();
  const double label = level.uncertainty.si();
  LevelLeftOut result = no_numbers(n);
  const Array1 standard = reading.uncertainty.standard();
  Array1 weight = Array1::Zero(n);
  for (Index i = 0; i < n; ++i) {
    if (!reading.answered(i)) continue;
    result.error[i] = reading.pressure[i] - level.pressure.si();
    result.uncertainty[i] = std::hypot(standard[i], label);
    weight[i] = 1.0;
  }
  if (2.0 * weight.sum() < static_cast<double>(n)) return result;
  weight /= weight.sum();
  result.mean_error = (weight * reading.pressure).sum() - level.pressure.si();
  result.mean_uncertainty =
      std::hypot(std::sqrt(std::max(0.0, reading.uncertainty.covariance(weight, weight))), label);
  return result;
}

}  // namespace

LeftOut leave_one_out(const calibration::ConstitutiveCurves& curves,
                      const calibration::FitCurvesOptions& options, const Stretch& stretch) {
  constexpr Index kStations = 30;
  constexpr std::size_t kFewest = 4;  // what is left must still make curves
  const std::vector<Index> stations = some_stations(curves.x, stretch, kStations);
  const auto n = static_cast<Index>(stations.size());
  LeftOut result;
  if (curves.levels.size() < kFewest || n < 2) return result;
  std::vector<Level> levels = curves.levels;
  for (Level& level : levels) level.profile = thinned(level.profile, stations);
  result.x = levels.front().profile.x;
  result.levels.assign(levels.size(), no_numbers(n));
  for (std::size_t k = 1; k + 1 < levels.size(); ++k) {
    std::vector<Level> others = levels;
    others.erase(others.begin() + static_cast<Index>(k));
    const calibration::ConstitutiveCurves of_others = calibration::fit_curves(others, options);
    result.levels[k] = compare(levels[k], read_pressure(of_others, levels[k].profile));
  }
  return result;
}

}  // namespace manoscope::inversion
