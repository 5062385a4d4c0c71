#include "manoscope/calibration/constitutive_curves.hpp"

#include <map>
#include <utility>

namespace manoscope::calibration {
namespace {

numerics::ShapeSpline make_spline(const PressureScale& scale,
                                  const std::vector<ConstitutiveCurve::Knot>& knots) {
  std::vector<double> u, y;
  for (const auto& knot : knots) {
    u.push_back(scale.coordinate(knot.pressure));
    y.push_back(knot.zeta);
  }
  return {std::move(u), std::move(y)};
}

}  // namespace

ConstitutiveCurve::ConstitutiveCurve(const PressureScale& scale, std::vector<Knot> knots)
    : scale_(scale), knots_(std::move(knots)), spline_(make_spline(scale_, knots_)) {}

double ConstitutiveCurve::zeta(double pressure) const {
  return spline_.value(scale_.coordinate(pressure));
}

double ConstitutiveCurve::slope(double pressure) const {
  return spline_.derivative(scale_.coordinate(pressure)) * scale_.derivative(pressure);
}

double ConstitutiveCurve::interpolation_doubt(double pressure) const {
  return spline_.doubt(scale_.coordinate(pressure));
}

Index ConstitutiveCurve::interval_level(double pressure) const {
  std::size_t j = 0;
  while (j + 2 < knots_.size() && knots_[j + 1].pressure <= pressure) ++j;
  return knots_[j].levels.front();
}

std::vector<double> ConstitutiveCurve::pressures(double zeta) const {
  std::vector<double> solutions = spline_.solve(zeta);
  for (double& solution : solutions) solution = scale_.pressure(solution);
  return solutions;
}

std::vector<ConstitutiveCurve::LevelWeight> ConstitutiveCurve::level_weights(
    double pressure) const {
  const double u = scale_.coordinate(pressure);
  std::map<Index, std::pair<double, double>> by_knot;  // by deflection, by position
  for (const auto& [j, weight] : spline_.weights(u)) by_knot[j].first += weight;
  for (const auto& [j, weight] : spline_.knot_weights(u)) by_knot[j].second += weight;
  std::vector<LevelWeight> weights;
  for (const auto& [j, weight] : by_knot) {
    const Knot& knot = knots_[static_cast<std::size_t>(j)];
    const double share = 1.0 / static_cast<double>(knot.levels.size());
    const double label = weight.second * scale_.derivative(knot.pressure);
    for (const Index level : knot.levels) {
      weights.push_back({level, share * weight.first, share * label});
    }
  }
  return weights;
}

std::vector<Level> ConstitutiveCurves::estimated_levels() const {
  std::vector<Level> estimated = levels;
  const Array1 uncertainty = level_uncertainty();
  for (std::size_t k = 0; k < estimated.size(); ++k) {
    estimated[k].pressure = Pressure::from_si(level_pressure[static_cast<Index>(k)]);
    estimated[k].uncertainty = Pressure::from_si(uncertainty[static_cast<Index>(k)]);
  }
  return estimated;
}

}  // namespace manoscope::calibration
