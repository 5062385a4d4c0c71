#include "manoscope/calibration/pressure_scale.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "manoscope/core/error.hpp"

namespace manoscope::calibration {
namespace {

/// Squared distance from their best straight line, summed over stations.
double distance_from_lines(const std::vector<Level>& levels, const PressureScale& scale) {
  std::vector<double> u;
  u.reserve(levels.size());
  for (const Level& level : levels) u.push_back(scale.coordinate(level.pressure.si()));
  double distance = 0.0;
  for (Index ix = 0; ix < levels.front().profile.x.size(); ++ix) {
    double n = 0.0, mean_u = 0.0, mean_zeta = 0.0;
    for (std::size_t k = 0; k < levels.size(); ++k) {
      if (levels[k].profile.flags[ix] != 0) continue;
      n += 1.0;
      mean_u += u[k];
      mean_zeta += levels[k].profile.zeta[ix];
    }
    if (n < 3.0) continue;
    mean_u /= n;
    mean_zeta /= n;
    double uu = 0.0, uz = 0.0, zz = 0.0;
    for (std::size_t k = 0; k < levels.size(); ++k) {
      if (levels[k].profile.flags[ix] != 0) continue;
      const double du = u[k] - mean_u, dz = levels[k].profile.zeta[ix] - mean_zeta;
      uu += du * du;
      uz += du * dz;
      zz += dz * dz;
    }
    distance += std::max(0.0, zz - uz * uz / uu);
  }
  return distance;
}

}  // namespace

PressureScale::PressureScale(double unit) : unit_(unit) { MANO_ASSERT(unit > 0.0); }

double PressureScale::coordinate(double pressure) const {
  // The real root of Cardano's equation, in the form that loses no digits for small p.
  constexpr double kRoot3 = std::numbers::sqrt3;
  return 2.0 / kRoot3 * std::sinh(std::asinh(1.5 * kRoot3 * pressure / unit_) / 3.0);
}

double PressureScale::pressure(double coordinate) const {
  return unit_ * coordinate * (1.0 + coordinate * coordinate);
}

double PressureScale::derivative(double pressure) const {
  const double u = coordinate(pressure);
  return 1.0 / (unit_ * (1.0 + 3.0 * u * u));
}

PressureScale fit_pressure_scale(const std::vector<Level>& levels) {
  MANO_ASSERT(levels.size() >= 2);
  std::vector<double> pressures;
  for (const Level& level : levels) pressures.push_back(level.pressure.si());
  std::sort(pressures.begin(), pressures.end());
  const double largest = std::max(std::abs(pressures.front()), std::abs(pressures.back()));
  double smallest_step = pressures.back() - pressures.front();
  for (std::size_t k = 1; k < pressures.size(); ++k) {
    const double step = pressures[k] - pressures[k - 1];
    if (step > 0.0) smallest_step = std::min(smallest_step, step);
  }
  MANO_ASSERT(smallest_step > 0.0);
  // The curves hardly depend on p_s near its optimum: a coarse grid does.
  constexpr double kRatio = 1.2;
  PressureScale best(100.0 * largest);
  double least = distance_from_lines(levels, best);
  for (double unit = best.unit() / kRatio; unit > 0.1 * smallest_step; unit /= kRatio) {
    const PressureScale scale(unit);
    const double distance = distance_from_lines(levels, scale);
    if (distance < least) {
      least = distance;
      best = scale;
    }
  }
  return best;
}

}  // namespace manoscope::calibration
