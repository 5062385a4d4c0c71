// The tube law from the clamped ends of the wall at uniform pressure.
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "manoscope/inversion/rest_rows.hpp"
#include "manoscope/inversion/tube_law.hpp"

namespace manoscope::inversion {
namespace {

using calibration::ConstitutiveCurves;
using End = FreeCurve::End;

constexpr double kSearchStep = 0.05, kSearchEnd = 1.0;  // widths
constexpr double kStep = 0.1;                           // widths between windows
constexpr int kWindows = 7;                             // at each end
constexpr double kLeastClear = 10.0;                    // curvature over its noise
constexpr Index kFewestLevels = 4;                      // of a law b(zeta)
constexpr double kCurveShare = 3e-3;  // of b: what noise of the labels does to f between levels

/// Stations that count, as make_weak_window() takes them.
Flags1 usable_stations(const Profile& profile) {
  return (profile.flags == 0).select(Flags1::Ones(profile.flags.size()), FlagBits{0});
}

/// Distance from the edge at which the wall is curved most under the highest pressure, mean over
/// the ends that show; 0 where neither does nearer than half a width.
double place_of_most_curvature(const ConstitutiveCurves& curves, double length, double width) {
  constexpr double kNearest = 0.5;  // widths
  Index top = 0;
  curves.level_pressure.maxCoeff(&top);
  const Profile& profile = curves.levels[static_cast<std::size_t>(top)].profile;
  const Flags1 usable = usable_stations(profile);
  const double half = window_half_width(curves.x, width);
  double most = 0.0, place = 0.0;
  for (double d = half; d < kSearchEnd * width; d += kSearchStep * width) {
    double sum = 0.0, n = 0.0;
    for (const double centre : {d, length - d}) {
      if (const auto window = make_weak_window(curves.x, usable, centre, half)) {
        sum += window->curvature_of(profile.zeta);
        n += 1.0;
      }
    }
    if (n == 0.0 || std::abs(sum) <= n * most) continue;
    most = std::abs(sum) / n;
    place = d;
  }
  return place < kNearest * width ? place : 0.0;
}

std::vector<EndZone> find_zones(const ConstitutiveCurves& curves, Length length, Length width,
                                double start) {
  const double half = window_half_width(curves.x, width.si());
  std::vector<EndZone> zones;
  for (const End end : {End::inlet, End::outlet}) {
    auto curve = FreeCurve::about(curves, length, width, end);
    if (!curve) continue;
    EndZone& zone = zones.emplace_back(EndZone{std::move(*curve), {}});
    for (const auto& level : curves.levels) {
      const Flags1 usable = usable_stations(level.profile);
      auto& windows = zone.windows.emplace_back();
      for (int i = 0; i < kWindows; ++i) {
        const double d = start + i * kStep * width.si();
        auto window =
            make_weak_window(curves.x, usable, end == End::inlet ? d : length.si() - d, half);
        if (window) windows.push_back(std::move(*window));
      }
    }
  }
  return zones;
}

/// The free deflection and stiffness at a level, means over the zones.
TubeLaw far_from_ends(const std::vector<EndZone>& zones, double pressure) {
  TubeLaw law;
  const auto n = static_cast<double>(zones.size());
  for (const EndZone& zone : zones) {
    const double zeta = zone.curve.deflection(pressure);
    law.deflection += zeta / n;
    law.stiffness += zone.curve.at_deflection(zeta).stiffness / n;
  }
  return law;
}

/// b0 of b = b0 + b2 zeta^2: tension grows with the square of the deflection.
std::optional<KnownNumber> limit_of_small(const std::vector<std::optional<TubeLaw>>& levels,
                                          const std::vector<CurvatureFit>& fits, Index n_shared) {
  std::vector<const TubeLaw*> laws;
  for (const auto& law : levels) {
    if (law) laws.push_back(&*law);
  }
  const auto n = static_cast<Index>(laws.size());
  if (n < kFewestLevels) return std::nullopt;
  Matrix model(n, 2);
  Eigen::VectorXd b(n), weight(n);
  for (Index k = 0; k < n; ++k) {
    const TubeLaw& law = *laws[static_cast<std::size_t>(k)];
    model.row(k) << 1.0, law.deflection * law.deflection;
    b[k] = law.b;
    weight[k] = std::pow(law.uncertainty, -2);
  }
  // Squares of deflection that hardly differ tell no law.
  constexpr double kLeastRatio = 2.0;
  if (model.col(1).maxCoeff() < kLeastRatio * model.col(1).minCoeff()) return std::nullopt;
  const double unit = model.col(1).maxCoeff();
  model.col(1) /= unit;
  const Matrix weighted = weight.asDiagonal() * model;
  const Matrix by_level = (model.transpose() * weighted).inverse() * weighted.transpose();
  const Eigen::VectorXd found = by_level * b;
  const Eigen::VectorXd share = by_level.row(0).transpose();
  Eigen::VectorXd shared = Eigen::VectorXd::Zero(n_shared);
  double own = 0.0, misfit = 0.0;
  for (Index k = 0; k < n; ++k) {
    const auto& fit = fits[static_cast<std::size_t>(k)];
    shared += share[k] * fit.effect.head(n_shared);
    own += share[k] * share[k] * fit.effect.tail(fit.effect.size() - n_shared).squaredNorm();
    misfit += std::abs(share[k]) * std::hypot(fit.misfit, kCurveShare * fit.b);
  }
  const double left = ((b - model * found).array().square() * weight.array()).sum();
  const double inflation = std::max(1.0, left / static_cast<double>(n - 2));
  return KnownNumber{found[0],
                     std::sqrt(inflation * (shared.squaredNorm() + own + misfit * misfit))};
}

}  // namespace

double TubeLaw::significance() const { return std::abs(b) / uncertainty; }

double TubeLaw::healing_length() const {
  return b < 0.0 ? std::sqrt(-b / stiffness) : std::numeric_limits<double>::quiet_NaN();
}

TubeLawAtRest tube_law_at_rest(const ConstitutiveCurves& curves, Length length, Length width,
                               const GaugeErrors& gauge) {
  TubeLawAtRest found;
  found.levels.resize(curves.levels.size());
  found.start = place_of_most_curvature(curves, length.si(), width.si());
  if (found.start == 0.0) {
    found.reason = "no end of the wall is in view";
    return found;
  }
  const auto zones = find_zones(curves, length, width, found.start);
  if (zones.empty()) {
    found.reason = "the wall is too short, or does not rise with pressure throughout";
    return found;
  }
  const RestRows writer(curves, zones, gauge);
  std::vector<CurvatureFit> fits;
  for (std::size_t k = 0; k < found.levels.size(); ++k) {
    auto fit = fit_curvature(writer.rows(static_cast<Index>(k)));
    if (!fit || fit->clearness < kLeastClear) continue;
    TubeLaw law = far_from_ends(zones, curves.level_pressure[static_cast<Index>(k)]);
    law.b = fit->b;
    law.misfit = fit->misfit;
    law.uncertainty = std::hypot(fit->uncertainty(), kCurveShare * law.b);
    found.levels[k] = law;
    fits.push_back(std::move(*fit));
  }
  if (fits.empty()) found.reason = "the wall is not curved along x near its ends";
  found.small = limit_of_small(found.levels, fits, writer.n_shared());
  return found;
}

}  // namespace manoscope::inversion
