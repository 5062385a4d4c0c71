#include "manoscope/inversion/intersections.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>

#include "manoscope/core/error.hpp"

namespace manoscope::inversion {
namespace {

/// Variance, m2, of the difference of two profiles at a station from the errors it shares along x.
double shared_variance(const Profile& state, const Profile& level, Index ix) {
  std::map<std::string, double> effects;
  for (const ErrorMode& mode : state.uncertainty.modes) effects[mode.variable] += mode.effect[ix];
  for (const ErrorMode& mode : level.uncertainty.modes) effects[mode.variable] -= mode.effect[ix];
  double variance = 0.0;
  for (const auto& [variable, effect] : effects) variance += effect * effect;
  return variance;
}

/// Difference of two profiles at the stations that count in both.
struct Difference {
  std::vector<double> x, value, sigma;
};

Difference subtract(const Profile& state, const Profile& level) {
  Difference difference;
  for (Index ix = 0; ix < state.x.size(); ++ix) {
    if (state.flags[ix] != 0 || level.flags[ix] != 0) continue;
    difference.x.push_back(state.x[ix]);
    difference.value.push_back(state.zeta[ix] - level.zeta[ix]);
    difference.sigma.push_back(
        std::hypot(state.uncertainty.independent[ix], level.uncertainty.independent[ix]));
  }
  return difference;
}

struct Line {
  double zero;        ///< where it crosses zero
  double zero_sigma;  ///< standard uncertainty of that, from independent noise
  double slope;       ///< of the difference
};

/// Least-squares line through the points within half a window of `centre`; nullopt if it is not
/// clearly sloped or crosses zero outside the window.
std::optional<Line> fit_zero(const Difference& d, double centre, double window) {
  double n = 0.0, sx = 0.0, sy = 0.0, variance = 0.0;
  const auto within = [&](std::size_t i) { return std::abs(d.x[i] - centre) <= 0.5 * window; };
  for (std::size_t i = 0; i < d.x.size(); ++i) {
    if (!within(i)) continue;
    n += 1.0;
    sx += d.x[i];
    sy += d.value[i];
    variance += d.sigma[i] * d.sigma[i];
  }
  if (n < 3.0) return std::nullopt;
  const double mean_x = sx / n, mean_y = sy / n;
  variance /= n;
  double sxx = 0.0, sxy = 0.0;
  for (std::size_t i = 0; i < d.x.size(); ++i) {
    if (!within(i)) continue;
    sxx += (d.x[i] - mean_x) * (d.x[i] - mean_x);
    sxy += (d.x[i] - mean_x) * (d.value[i] - mean_y);
  }
  if (sxx <= 0.0 || sxy == 0.0) return std::nullopt;
  constexpr double kClear = 3.0;
  const double slope = sxy / sxx, slope_sigma = std::sqrt(variance / sxx);
  if (std::abs(slope) < kClear * slope_sigma) return std::nullopt;
  const double zero = mean_x - mean_y / slope;
  if (std::abs(zero - centre) > window) return std::nullopt;
  const double lever = zero - mean_x;
  const double value_sigma = std::sqrt(variance / n + lever * lever * variance / sxx);
  return Line{zero, value_sigma / std::abs(slope), slope};
}

}  // namespace

void IntersectionOptions::validate() const {
  if (window && (!std::isfinite(window->si()) || *window <= Length{})) {
    throw InputError("--crossing-window", fmt::format("is {:.4g} um", window->in(um)),
                     "Give a length above 0, or auto");
  }
}

std::vector<Intersection> find_intersections(const std::vector<calibration::Level>& levels,
                                             const Profile& state, Length channel_width,
                                             const IntersectionOptions& options) {
  options.validate();
  const double window = options.window.value_or(0.1 * channel_width).si();
  std::vector<Intersection> found;
  for (const calibration::Level& level : levels) {
    const Difference difference = subtract(state, level.profile);
    std::vector<double> changes;
    for (std::size_t i = 1; i < difference.x.size(); ++i) {
      const double before = difference.value[i - 1], after = difference.value[i];
      if ((before < 0.0) != (after < 0.0)) {
        changes.push_back(0.5 * (difference.x[i - 1] + difference.x[i]));
      }
    }
    for (std::size_t first = 0; first < changes.size();) {
      std::size_t last = first;
      while (last + 1 < changes.size() && changes[last + 1] - changes[last] < window) ++last;
      // An even number of changes leaves the sign as it was: the profiles touched, or only noise
      // did.
      const bool crosses = (last - first) % 2 == 0;
      const auto line = fit_zero(difference, 0.5 * (changes[first] + changes[last]),
                                 window + changes[last] - changes[first]);
      if (crosses && line) {
        Index nearest = 0;
        (state.x - line->zero).abs().minCoeff(&nearest);
        const double shared =
            std::sqrt(shared_variance(state, level.profile, nearest)) / std::abs(line->slope);
        found.push_back({Length::from_si(line->zero),
                         Length::from_si(std::hypot(line->zero_sigma, shared)), level.pressure,
                         level.uncertainty});
      }
      first = last + 1;
    }
  }
  return found;
}

}  // namespace manoscope::inversion
