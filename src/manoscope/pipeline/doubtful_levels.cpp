#include <algorithm>
#include <cmath>
#include <vector>

#include "manoscope/inversion/read_pressure.hpp"
#include "manoscope/numerics/robust.hpp"
#include "manoscope/pipeline/assemble.hpp"

namespace manoscope::pipeline {
namespace {

using calibration::Level;

/// The profile at every step-th station of [first, last].
Profile thinned(const Profile& profile, const std::vector<Index>& stations) {
  const auto n = static_cast<Index>(stations.size());
  Profile result;
  result.x = result.zeta = Array1(n);
  result.flags = Flags1(n);
  result.uncertainty.independent = Array1(n);
  for (const ErrorMode& mode : profile.uncertainty.modes) {
    result.uncertainty.modes.push_back({mode.variable, mode.source, Array1(n)});
  }
  for (Index i = 0; i < n; ++i) {
    const Index ix = stations[static_cast<std::size_t>(i)];
    result.x[i] = profile.x[ix];
    result.zeta[i] = profile.zeta[ix];
    result.flags[i] = profile.flags[ix];
    result.uncertainty.independent[i] = profile.uncertainty.independent[ix];
    for (std::size_t k = 0; k < result.uncertainty.modes.size(); ++k) {
      result.uncertainty.modes[k].effect[i] = profile.uncertainty.modes[k].effect[ix];
    }
  }
  return result;
}

/// Median over the stations of reading and pull; nullopt if fewer than half have an answer.
std::optional<LevelDoubt> read_left_out(const Level& level,
                                        const inversion::PressureReading& reading) {
  const Array1 sigma = reading.uncertainty.standard();
  std::vector<double> read, pull;
  for (Index ix = 0; ix < reading.x.size(); ++ix) {
    if (!reading.answered(ix)) continue;
    const double doubt = std::hypot(sigma[ix], level.uncertainty.si());
    if (!(doubt > 0.0)) continue;
    read.push_back(reading.pressure[ix]);
    pull.push_back((reading.pressure[ix] - level.pressure.si()) / doubt);
  }
  if (2 * static_cast<Index>(read.size()) < reading.x.size() || read.empty()) return std::nullopt;
  return LevelDoubt{level.name, level.pressure.si(), numerics::median(read),
                    numerics::median(pull)};
}

}  // namespace

std::vector<LevelDoubt> doubtful_levels(const calibration::ConstitutiveCurves& curves,
                                        const calibration::FitCurvesOptions& options) {
  constexpr double kSure = 5.0;
  constexpr Index kStations = 25;
  const Index n = curves.x.size();
  std::vector<Index> stations;
  for (Index i = 0; i < kStations; ++i) {
    const Index ix = n / 4 + i * (n / 2) / kStations;
    if (stations.empty() || ix > stations.back()) stations.push_back(ix);
  }
  std::vector<Level> levels = curves.levels;
  for (Level& level : levels) level.profile = thinned(level.profile, stations);
  // Each label against curves through the others as they were read.
  calibration::FitCurvesOptions as_read = options;
  as_read.joint_labels = false;
  std::vector<LevelDoubt> doubts;
  constexpr std::size_t kFewest = 4;  // what is left must still make curves
  if (levels.size() < kFewest) return doubts;
  for (std::size_t k = 1; k + 1 < levels.size(); ++k) {
    std::vector<Level> others = levels;
    others.erase(others.begin() + static_cast<Index>(k));
    const auto reading =
        inversion::read_pressure(calibration::fit_curves(others, as_read), levels[k].profile);
    const auto doubt = read_left_out(levels[k], reading);
    if (doubt && std::abs(doubt->pull) > kSure) doubts.push_back(*doubt);
  }
  return doubts;
}

}  // namespace manoscope::pipeline
