#include "manoscope/inversion/station_stiffness.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <string>

namespace manoscope::inversion {
namespace {

using calibration::ConstitutiveCurves;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// A level and its neighbours; at the outer levels one of them twice.
struct Stencil {
  std::array<Index, 3> level;
  /// (3, n_x) 1/m: by how much the slope at the middle one follows the pressure of each. Of a
  /// parabola p(zeta) through them, or a straight line through two; NaN where zeta does not rise.
  Array2 weight;
};

Stencil stencil_about(const ConstitutiveCurves& curves, Index k) {
  const Index last = static_cast<Index>(curves.levels.size()) - 1, n_x = curves.x.size();
  Stencil stencil{{std::max<Index>(0, k - 1), k, std::min(last, k + 1)},
                  Array2::Constant(3, n_x, kNan)};
  const auto profile = [&](int j) -> const Profile& {
    return curves.levels[static_cast<std::size_t>(stencil.level[static_cast<std::size_t>(j)])]
        .profile;
  };
  for (Index ix = 0; ix < n_x; ++ix) {
    if (profile(0).flags[ix] != 0 || profile(1).flags[ix] != 0 || profile(2).flags[ix] != 0) {
      continue;
    }
    const double below = profile(1).zeta[ix] - profile(0).zeta[ix];
    const double above = profile(2).zeta[ix] - profile(1).zeta[ix];
    if ((k > 0 && !(below > 0.0)) || (k < last && !(above > 0.0))) continue;
    if (k == 0) {
      stencil.weight.col(ix) << 0.0, -1.0 / above, 1.0 / above;
    } else if (k == last) {
      stencil.weight.col(ix) << -1.0 / below, 1.0 / below, 0.0;
    } else {
      const double down = above / (below * (below + above)), up = below / (above * (below + above));
      stencil.weight.col(ix) << -down, down - up, up;
    }
  }
  return stencil;
}

/// Variance of the slope over the square of the slope itself by the maps, (n_x): a level that lies
/// higher by d acts as a pressure lower by slope times d.
Array1 map_variance(const ConstitutiveCurves& curves, const Stencil& stencil) {
  Array1 variance = Array1::Zero(curves.x.size());
  std::map<std::string, Array1> shared;
  for (std::size_t j = 0; j < 3; ++j) {
    const Array1 weight = stencil.weight.row(static_cast<Index>(j)).transpose();
    const Uncertainty& of =
        curves.levels[static_cast<std::size_t>(stencil.level[j])].profile.uncertainty;
    variance += (weight * of.independent).square();
    for (const ErrorMode& mode : of.modes) {
      auto [place, is_new] = shared.try_emplace(mode.variable, Array1::Zero(weight.size()));
      place->second += weight * mode.effect;
    }
  }
  for (const auto& [variable, effect] : shared) variance += effect.square();
  return variance;
}

}  // namespace

StationStiffness station_stiffness(const ConstitutiveCurves& curves, const GaugeErrors& gauge) {
  const auto n_levels = static_cast<Index>(curves.levels.size());
  const Index n_x = curves.x.size();
  StationStiffness result{Array2::Constant(n_levels, n_x, kNan),
                          Array2::Constant(n_levels, n_x, kNan)};
  for (Index k = 0; k < n_levels; ++k) {
    const Stencil stencil = stencil_about(curves, k);
    const Array1 maps = map_variance(curves, stencil);
    for (Index ix = 0; ix < n_x; ++ix) {
      const auto& curve = curves.curves[static_cast<std::size_t>(ix)];
      if (!curve || std::isnan(stencil.weight(1, ix))) continue;
      const double p = std::clamp(curves.level_pressure[k], curve->lowest(), curve->highest());
      const double slope = curve->slope(p);
      if (!(slope > 0.0)) continue;
      double parabola = 0.0;
      Eigen::RowVectorXd label = Eigen::RowVectorXd::Zero(curves.label_effect.cols());
      for (std::size_t j = 0; j < 3; ++j) {
        label +=
            stencil.weight(static_cast<Index>(j), ix) * curves.label_effect.row(stencil.level[j]);
        parabola +=
            stencil.weight(static_cast<Index>(j), ix) * curves.level_pressure[stencil.level[j]];
      }
      result.value(k, ix) = 1.0 / slope;
      result.uncertainty(k, ix) = std::hypot(std::hypot(std::sqrt(maps[ix]), gauge.gain) / slope,
                                             label.norm(), 1.0 / slope - parabola);
    }
  }
  return result;
}

}  // namespace manoscope::inversion
