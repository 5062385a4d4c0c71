#include "manoscope/inversion/free_curve.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "manoscope/calibration/pressure_scale.hpp"

namespace manoscope::inversion {
namespace {

using calibration::ConstitutiveCurve;
using calibration::ConstitutiveCurves;

constexpr double kFrom = 2.0, kTo = 3.0;  // widths from the end
constexpr double kShortest = 4.0;         // widths, of a channel
constexpr int kPerInterval = 8;           // points of the table between two knots
constexpr double kBeyond = 0.1;           // of the outer interval, straight on
constexpr std::size_t kFewestKnots = 3;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

bool counts(const ConstitutiveCurves& curves, Index ix) {
  if (!curves.curves[static_cast<std::size_t>(ix)]) return false;
  return std::all_of(curves.levels.begin(), curves.levels.end(),
                     [&](const auto& level) { return level.profile.flags[ix] == 0; });
}

/// Stations between two distances from an end at which every level counts: first and number of
/// those up to the last, and which of them count.
struct Reference {
  Index first = 0;
  std::vector<bool> used;
  Index n_used = 0;
};

Reference find_reference(const ConstitutiveCurves& curves, double length, double width,
                         FreeCurve::End end) {
  // A short channel has its reference about its middle.
  const double to = std::min(kTo * width, 0.5 * length);
  const double from = std::min(kFrom * width, to - (kTo - kFrom) * 0.5 * width);
  Reference reference;
  for (Index ix = 0; ix < curves.x.size(); ++ix) {
    const double distance = end == FreeCurve::End::inlet ? curves.x[ix] : length - curves.x[ix];
    if (distance < from || distance > to) continue;
    if (reference.used.empty()) reference.first = ix;
    reference.used.push_back(counts(curves, ix));
    reference.n_used += reference.used.back() ? 1 : 0;
  }
  return reference;
}

double mean_deflection(const ConstitutiveCurves& curves, const Reference& reference, Index level) {
  const Array1& zeta = curves.levels[static_cast<std::size_t>(level)].profile.zeta;
  double sum = 0.0;
  for (std::size_t i = 0; i < reference.used.size(); ++i) {
    if (reference.used[i]) sum += zeta[reference.first + static_cast<Index>(i)];
  }
  return sum / static_cast<double>(reference.n_used);
}

/// The scale in which these knots lie most nearly on a line.
calibration::PressureScale scale_of(const std::vector<ConstitutiveCurve::Knot>& knots) {
  std::vector<calibration::Level> levels;
  for (const auto& knot : knots) {
    calibration::Level level;
    level.pressure = Pressure::from_si(knot.pressure);
    level.profile.x = level.profile.uncertainty.independent = Array1::Zero(1);
    level.profile.zeta = Array1::Constant(1, knot.zeta);
    level.profile.flags = Flags1::Zero(1);
    levels.push_back(std::move(level));
  }
  return calibration::fit_pressure_scale(levels);
}

}  // namespace

std::optional<FreeCurve> FreeCurve::about(const ConstitutiveCurves& curves, Length length,
                                          Length width, End end) {
  if (length.si() < kShortest * width.si()) return std::nullopt;
  const Reference reference = find_reference(curves, length.si(), width.si(), end);
  const auto middle = std::find(reference.used.begin(), reference.used.end(), true);
  if (middle == reference.used.end()) return std::nullopt;
  const auto model = static_cast<std::size_t>(reference.first + (middle - reference.used.begin()));

  FreeCurve curve;
  std::vector<ConstitutiveCurve::Knot> knots = curves.curves[model]->knots();
  for (auto& knot : knots) {
    knot.zeta = 0.0;
    for (const Index k : knot.levels) knot.zeta += mean_deflection(curves, reference, k);
    knot.zeta /= static_cast<double>(knot.levels.size());
    if (!curve.knots_.empty() && !(knot.zeta > curve.knots_.back().zeta)) return std::nullopt;
    curve.knots_.push_back({knot.zeta, knot.levels});
  }
  if (knots.size() < kFewestKnots) return std::nullopt;
  for (std::size_t i = 0; i < reference.used.size(); ++i) {
    if (reference.used[i]) curve.stations_.push_back(reference.first + static_cast<Index>(i));
  }
  const ConstitutiveCurve fine(scale_of(knots), knots);
  for (std::size_t j = 0; j + 1 < knots.size(); ++j) {
    const double step = (knots[j + 1].pressure - knots[j].pressure) / kPerInterval;
    for (int i = 0; i < kPerInterval; ++i) curve.add_point(fine, knots[j].pressure + i * step);
  }
  curve.add_point(fine, knots.back().pressure);
  const auto rises = [](double stiffness) { return std::isfinite(stiffness) && stiffness > 0.0; };
  if (!std::all_of(curve.stiffness_.begin(), curve.stiffness_.end(), rises)) return std::nullopt;
  return curve;
}

void FreeCurve::add_point(const ConstitutiveCurve& curve, double pressure) {
  const double slope = curve.slope(pressure);
  zeta_.push_back(curve.zeta(pressure));
  pressure_.push_back(pressure);
  stiffness_.push_back(slope > 0.0 ? 1.0 / slope : kNan);
  doubt_.push_back(-curve.interpolation_doubt(pressure) * stiffness_.back());
}

FreeCurve::Point FreeCurve::at_deflection(double zeta) const {
  const std::size_t n = zeta_.size();
  const auto above = std::upper_bound(zeta_.begin(), zeta_.end(), zeta) - zeta_.begin();
  const auto j = static_cast<std::size_t>(std::clamp<Index>(above, 1, static_cast<Index>(n) - 1));
  if (zeta < zeta_.front() || zeta > zeta_.back()) {
    const bool low = zeta < zeta_.front();
    const std::size_t end = low ? 0 : n - 1, neighbour = low ? 1 : knots_.size() - 1;
    const double reach = kBeyond * (knots_[neighbour].zeta - knots_[neighbour - 1].zeta);
    const double beyond = zeta - zeta_[end];
    if (std::abs(beyond) > reach) return {kNan, kNan, kNan};
    return {pressure_[end] + stiffness_[end] * beyond, stiffness_[end], 0.0};
  }
  // The cubic p(zeta) with both pressures and both slopes.
  const double h = zeta_[j] - zeta_[j - 1], s = (zeta - zeta_[j - 1]) / h;
  const double m0 = h * stiffness_[j - 1], m1 = h * stiffness_[j];
  const double step = pressure_[j] - pressure_[j - 1];
  const double c2 = 3.0 * step - 2.0 * m0 - m1, c3 = m0 + m1 - 2.0 * step;
  return {pressure_[j - 1] + s * (m0 + s * (c2 + s * c3)), (m0 + s * (2.0 * c2 + 3.0 * s * c3)) / h,
          doubt_[j - 1] + s * (doubt_[j] - doubt_[j - 1])};
}

double FreeCurve::deflection(double pressure) const {
  const auto above =
      std::upper_bound(pressure_.begin(), pressure_.end(), pressure) - pressure_.begin();
  const auto j = static_cast<std::size_t>(
      std::clamp<Index>(above, 1, static_cast<Index>(pressure_.size()) - 1));
  const double share =
      std::clamp((pressure - pressure_[j - 1]) / (pressure_[j] - pressure_[j - 1]), 0.0, 1.0);
  return zeta_[j - 1] + share * (zeta_[j] - zeta_[j - 1]);
}

std::pair<std::size_t, double> FreeCurve::place(double zeta) const {
  std::size_t j = 1;
  while (j + 1 < knots_.size() && knots_[j].zeta <= zeta) ++j;
  const double share = (zeta - knots_[j - 1].zeta) / (knots_[j].zeta - knots_[j - 1].zeta);
  return {j - 1, std::clamp(share, 0.0, 1.0)};
}

}  // namespace manoscope::inversion
