#include "manoscope/inversion/wall_response.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "manoscope/core/error.hpp"

namespace manoscope::inversion {
namespace {

/// Enough for the ends, where the kernel changes fastest, with cells 3 % of the width long; across,
/// the average needs few. Against 28 x 10 cells readings of S1 and S3 change by less than their
/// uncertainty.
constexpr Index kCellsAlong = 40, kCellsAcross = 4;

wall::FopplVonKarmanOptions grid_options(double highest) {
  wall::FopplVonKarmanOptions options;
  options.n_cells_x = kCellsAlong;
  options.n_cells_z = kCellsAcross;
  options.design_pressure = Pressure::from_si(highest);
  options.tolerance = 1e-8;
  return options;
}

/// Curves as a calibration would draw them.
/// @param deflection  (n_levels, n) m.
std::vector<calibration::ConstitutiveCurve> curves_through(const Array1& pressures,
                                                           const Array2& deflection) {
  std::vector<calibration::Level> levels;
  for (Index k = 0; k < pressures.size(); ++k) {
    calibration::Level level;
    level.pressure = Pressure::from_si(pressures[k]);
    level.profile.x = Array1::LinSpaced(deflection.cols(), 0.0, 1.0);
    level.profile.zeta = deflection.row(k);
    level.profile.flags = Flags1::Zero(deflection.cols());
    levels.push_back(std::move(level));
  }
  const calibration::PressureScale scale = calibration::fit_pressure_scale(levels);
  std::vector<calibration::ConstitutiveCurve> curves;
  for (Index i = 0; i < deflection.cols(); ++i) {
    std::vector<calibration::ConstitutiveCurve::Knot> knots;
    for (Index k = 0; k < pressures.size(); ++k) {
      knots.push_back({{k}, pressures[k], deflection(k, i)});
    }
    curves.emplace_back(scale, std::move(knots));
  }
  return curves;
}

}  // namespace

Array1 graded_nodes(Length length, Length width, double at_ends) {
  constexpr double kCoarse = 0.12, kZone = 0.7, kGrowth = 0.2;  // widths, per width
  const double half = 0.5 * length.si(), w = width.si();
  std::vector<double> left{0.0};
  while (left.back() < half) {
    const double beyond = left.back() - kZone * w;
    left.push_back(left.back() + (beyond < 0.0
                                      ? at_ends * w
                                      : std::min(kCoarse * w, at_ends * w + kGrowth * beyond)));
  }
  const double stretch = half / left.back();
  const auto n = static_cast<Index>(left.size());
  Array1 nodes(2 * n - 1);
  for (Index i = 0; i < n; ++i) {
    nodes[i] = stretch * left[static_cast<std::size_t>(i)];
    nodes[2 * n - 2 - i] = length.si() - nodes[i];
  }
  return nodes;
}

Array1 response_nodes(Length length, Length width) {
  constexpr double kAtEnds = 0.035;  // widths
  return graded_nodes(length, width, kAtEnds);
}

double half_response_wavelength(const Array1& nodes, const Eigen::VectorXd& answer, Index node) {
  const Array1 distance = nodes - nodes[node];
  const auto shown = [&](double wavelength) {
    const double k = 2.0 * std::numbers::pi / wavelength;
    return (answer.array() * (k * distance).cos()).sum() / answer.sum();
  };
  const double shortest = 2.0 * (nodes[node + 1] - nodes[node]);
  double low = shortest, high = nodes[nodes.size() - 1];
  if (shown(low) > 0.5 || shown(high) < 0.5) return 0.0;
  while (high > 1.001 * low) {
    const double middle = std::sqrt(low * high);
    (shown(middle) < 0.5 ? low : high) = middle;
  }
  return std::sqrt(low * high);
}

WallResponse::WallResponse(const wall::ClampedWall& wall, const Array1& levels,
                           const Monitor& monitor)
    : wall_(wall, grid_options(levels.maxCoeff()), monitor),
      nodes_(response_nodes(wall.length, wall.width)),
      levels_(levels) {
  MANO_ASSERT(levels.size() >= 3);
  const auto start = wall_.equilibrium(wall::WallLoad::uniform(Pressure::from_si(levels[0])));
  wall::LoadPath path = wall::follow_pressure(wall_, start, levels);
  if (!path.snaps.empty()) {
    throw InputError("wall model",
                     fmt::format("snaps through at {:.0f} Pa", path.snaps.front().pressure.si()),
                     "Such a wall is read station by station");
  }
  states_ = std::move(path.states);
  const Index n_levels = levels.size(), n = nodes_.size();
  deflection_ = compliance_ = Array2(n_levels, n);
  for (Index k = 0; k < n_levels; ++k) {
    const wall::WallState& state = states_[static_cast<std::size_t>(k)];
    const auto rate = wall_.rate(state, wall::WallLoad::uniform(1.0 * Pa));
    deflection_.row(k) = state.average_deflection(nodes_);
    compliance_.row(k) = wall_.predicted(state, 1.0, rate).average_deflection(nodes_).transpose() -
                         deflection_.row(k);
  }
  const auto inside = [&](const Array2& values) { return values.middleCols(1, n - 2); };
  const bool rises =
      (inside(compliance_) > 0.0).all() &&
      (inside(deflection_).bottomRows(n_levels - 1) > inside(deflection_).topRows(n_levels - 1))
          .all();
  if (!rises) {
    throw InputError("wall model", "falls somewhere while the pressure rises",
                     "Such a wall is read station by station");
  }
  curves_ = curves_through(levels_, inside(deflection_));
}

Array2 WallResponse::profiles(const Array1& x) const {
  Array2 result(levels_.size(), x.size());
  for (Index k = 0; k < levels_.size(); ++k) {
    result.row(k) = states_[static_cast<std::size_t>(k)].average_deflection(x);
  }
  return result;
}

WallResponse::Inverse WallResponse::invert(Index node, double deflection) const {
  const Index n = levels_.size();
  const auto of = [&](Index k) { return deflection_(k, node); };
  if (deflection <= of(0) || deflection >= of(n - 1)) {
    const Index end = deflection <= of(0) ? 0 : n - 1;
    const double slope = 1.0 / compliance_(end, node);
    return {levels_[end] + slope * (deflection - of(end)), slope};
  }
  const calibration::ConstitutiveCurve& curve = curves_[static_cast<std::size_t>(node - 1)];
  const double pressure = curve.pressures(deflection).front();
  return {pressure, 1.0 / curve.slope(pressure)};
}

WallResponse::Answer WallResponse::answer(const Eigen::VectorXd& pressure) const {
  const Index n = nodes_.size();
  MANO_ASSERT(pressure.size() == n);
  Index nearest = 0;
  (levels_ - pressure.mean()).abs().minCoeff(&nearest);
  const auto load = wall::WallLoad::along(nodes_, pressure.array());
  const wall::WallState state = wall_.equilibrium(load, states_[static_cast<std::size_t>(nearest)]);
  const Array1 deflection = state.average_deflection(nodes_);
  Answer answer{pressure, wall_.influence(state, nodes_)};
  for (const Index end : {Index{0}, n - 1}) {
    answer.kernel.row(end).setZero();
    answer.kernel(end, end) = 1.0;
  }
  for (Index i = 1; i < n - 1; ++i) {
    const Inverse inverse = invert(i, deflection[i]);
    answer.reading[i] = inverse.pressure;
    answer.kernel.row(i) *= inverse.slope;
  }
  return answer;
}

double WallResponse::half_wavelength(const Matrix& kernel, Index node) const {
  return half_response_wavelength(nodes_, kernel.row(node), node);
}

}  // namespace manoscope::inversion
