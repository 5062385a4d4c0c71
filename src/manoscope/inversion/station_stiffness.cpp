#include "manoscope/inversion/station_stiffness.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace manoscope::inversion {
namespace {

using calibration::ConstitutiveCurves;

/// Variance of the difference of two profiles, (n_x) m2; the same error in both cancels.
Array1 difference_variance(const Profile& upper, const Profile& lower) {
  Array1 variance = upper.uncertainty.independent.square() + lower.uncertainty.independent.square();
  const auto& others = lower.uncertainty.modes;
  std::vector<bool> shared(others.size(), false);
  for (const ErrorMode& mode : upper.uncertainty.modes) {
    const auto same = std::find_if(others.begin(), others.end(), [&](const ErrorMode& other) {
      return other.variable == mode.variable;
    });
    if (same == others.end()) {
      variance += mode.effect.square();
      continue;
    }
    shared[static_cast<std::size_t>(same - others.begin())] = true;
    variance += (mode.effect - same->effect).square();
  }
  for (std::size_t j = 0; j < others.size(); ++j) {
    if (!shared[j]) variance += others[j].effect.square();
  }
  return variance;
}

}  // namespace

StationStiffness station_stiffness(const ConstitutiveCurves& curves, const GaugeErrors& gauge) {
  const auto n_levels = static_cast<Index>(curves.levels.size());
  const Index n_x = curves.x.size();
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  StationStiffness result{Array2::Constant(n_levels, n_x, kNan),
                          Array2::Constant(n_levels, n_x, kNan)};
  for (Index k = 0; k < n_levels; ++k) {
    const Index low = std::max<Index>(0, k - 1), high = std::min(n_levels - 1, k + 1);
    const Profile& upper = curves.levels[static_cast<std::size_t>(high)].profile;
    const Profile& lower = curves.levels[static_cast<std::size_t>(low)].profile;
    const Array1 variance = difference_variance(upper, lower);
    const double step = curves.level_pressure[high] - curves.level_pressure[low];
    const double label =
        (curves.label_effect.row(high) - curves.label_effect.row(low)).norm() / step;
    for (Index ix = 0; ix < n_x; ++ix) {
      const auto& curve = curves.curves[static_cast<std::size_t>(ix)];
      if (!curve || upper.flags[ix] != 0 || lower.flags[ix] != 0) continue;
      const double p = std::clamp(curves.level_pressure[k], curve->lowest(), curve->highest());
      const double slope = curve->slope(p), rise = upper.zeta[ix] - lower.zeta[ix];
      if (!(slope > 0.0) || !(rise > 0.0)) continue;
      result.value(k, ix) = 1.0 / slope;
      result.uncertainty(k, ix) =
          std::hypot(std::sqrt(variance[ix]) / rise, label, gauge.gain) / slope;
    }
  }
  return result;
}

}  // namespace manoscope::inversion
