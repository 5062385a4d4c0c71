#include "manoscope/inversion/read_pressure.hpp"

#include <fmt/format.h>

#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <map>
#include <string>

#include "manoscope/core/error.hpp"
#include "manoscope/core/flags.hpp"

namespace manoscope::inversion {
namespace {

using calibration::ConstitutiveCurve;
using calibration::ConstitutiveCurves;

/// Collects the effect of shared error variables, station by station, in order of appearance.
class ModeTable {
 public:
  explicit ModeTable(Index n) : n_(n) {}

  /// Row of a variable; made of zeros when first asked for.
  Array1& effect(const std::string& variable, const std::string& source) {
    const auto [place, is_new] = rows_.try_emplace(variable, modes_.size());
    if (is_new) modes_.push_back({variable, source, Array1::Zero(n_)});
    return modes_[place->second].effect;
  }
  std::vector<ErrorMode> take() { return std::move(modes_); }

 private:
  Index n_;
  std::map<std::string, std::size_t> rows_;
  std::vector<ErrorMode> modes_;
};

/// Sum over levels of weight times effect, for every variable the levels' profiles share along x.
void add_level_modes(const ConstitutiveCurves& curves, const Matrix& weight, ModeTable& table) {
  for (std::size_t k = 0; k < curves.levels.size(); ++k) {
    const auto column = weight.col(static_cast<Index>(k)).array();
    if ((column == 0.0).all()) continue;
    for (const ErrorMode& mode : curves.levels[k].profile.uncertainty.modes) {
      table.effect(mode.variable, mode.source) -= column * mode.effect;
    }
  }
}

/// Whether deflections within `reach` of `zeta` have more than one pressure: whether any falling
/// stretch of the curve spans one of them.
bool near_fold(const ConstitutiveCurve& curve, double zeta, double reach) {
  const auto& knots = curve.knots();
  for (std::size_t j = 1; j < knots.size(); ++j) {
    const double above = knots[j - 1].zeta, below = knots[j].zeta;
    if (below < above && zeta + reach >= below && zeta - reach <= above) return true;
  }
  return false;
}

/// The one pressure that fits, or the flag that says why there is none.
FlagBits solve_station(const ConstitutiveCurve& curve, double zeta, double sigma, double reach,
                       double& pressure) {
  const std::vector<double> solutions = curve.pressures(zeta);
  if (near_fold(curve, zeta, reach * sigma) && !solutions.empty()) return ReadingFlag::ambiguous;
  if (solutions.empty()) return ReadingFlag::out_of_calibration;
  if (solutions.size() > 1) return ReadingFlag::ambiguous;
  pressure = solutions.front();
  return 0;
}

}  // namespace

void ReadPressureOptions::validate() const {
  const auto refuse = [](const char* name, double value, const char* bound) {
    throw InputError(name, fmt::format("is {}", value), fmt::format("Give a number {}", bound));
  };
  if (!(coverage > 0.0 && coverage < 1.0)) refuse("--coverage", coverage, "in (0, 1)");
  if (!(largest_uncertainty > 0.0)) {
    refuse("--largest-uncertainty", largest_uncertainty, "above 0");
  }
  if (!(ambiguity_reach >= 0.0)) refuse("--ambiguity-reach", ambiguity_reach, "of 0 or more");
}

bool PressureReading::answered(Index ix) const { return (flags[ix] & ReadingFlag::no_answer) == 0; }

PressureReading read_pressure(const ConstitutiveCurves& curves, const Profile& state,
                              const GaugeErrors& gauge, const ReadPressureOptions& options) {
  options.validate();
  const Index n = curves.x.size(), n_levels = static_cast<Index>(curves.levels.size());
  if (state.x.size() != n || !(state.x == curves.x).all()) {
    throw InputError("flow map", "has other stations along x than the calibration",
                     "Take all maps of one experiment with the same camera settings");
  }
  PressureReading reading;
  reading.x = curves.x;
  reading.pressure = reading.slope = Array1::Zero(n);
  reading.flags = Flags1::Zero(n);
  Array1 variance = Array1::Zero(n);  // Pa2, independent from station to station
  Array1 inverse_slope = Array1::Zero(n);
  Matrix deflection_weight = Matrix::Zero(n, n_levels);  // d p / d zeta_level, with its sign turned
  Matrix label_weight = Matrix::Zero(n, n_levels);       // d p / d p_level
  Matrix interpolation = Matrix::Zero(n, n_levels);      // Pa, between a level and the next
  const Array1 state_sigma = state.uncertainty.standard();
  const double range = curves.level_pressure.maxCoeff() - curves.level_pressure.minCoeff();

  for (Index ix = 0; ix < n; ++ix) {
    const auto& curve = curves.curves[static_cast<std::size_t>(ix)];
    if (state.flags[ix] != 0) {
      reading.flags[ix] = ReadingFlag::no_data;
      continue;
    }
    if (!curve) {
      reading.flags[ix] = ReadingFlag::insensitive;
      continue;
    }
    double pressure = 0.0;
    reading.flags[ix] =
        solve_station(*curve, state.zeta[ix], state_sigma[ix], options.ambiguity_reach, pressure);
    if (reading.flags[ix] != 0) continue;
    const double slope = curve->slope(pressure);
    if (!(slope > 0.0)) {
      // A turning point, or a falling branch that no other branch overlaps: no honest first order.
      reading.flags[ix] = slope < 0.0 ? ReadingFlag::ambiguous : ReadingFlag::insensitive;
      continue;
    }
    reading.pressure[ix] = pressure;
    reading.slope[ix] = slope;
    inverse_slope[ix] = 1.0 / slope;
    const double state_noise = state.uncertainty.independent[ix];
    double squares = state_noise * state_noise;
    interpolation(ix, curve->interval_level(pressure)) =
        -curve->interpolation_doubt(pressure) / slope;
    for (const auto& weight : curve->level_weights(pressure)) {
      const auto& level = curves.levels[static_cast<std::size_t>(weight.level)];
      const double noise = weight.deflection * level.profile.uncertainty.independent[ix];
      squares += noise * noise;
      deflection_weight(ix, weight.level) += weight.deflection / slope;
      label_weight(ix, weight.level) -= weight.label / slope;
    }
    variance[ix] = squares / (slope * slope);
  }

  ModeTable table(n);
  for (const ErrorMode& mode : state.uncertainty.modes) {
    table.effect(mode.variable, mode.source) += inverse_slope * mode.effect;
  }
  add_level_modes(curves, deflection_weight, table);
  if (gauge.zero > Pressure{}) {
    Array1 share(n_levels);
    for (Index k = 0; k < n_levels; ++k) {
      share[k] = curves.levels[static_cast<std::size_t>(k)].gauge_share;
    }
    table.effect("gauge zero", "gauge zero") +=
        (label_weight * (curves.label_response * share.matrix())).array() * gauge.zero.si();
  }
  const Matrix label_effects = label_weight * curves.label_effect;
  for (Index j = 0; j < label_effects.cols(); ++j) {
    if ((label_effects.col(j).array() == 0.0).all()) continue;
    table.effect(curves.label_error[static_cast<std::size_t>(j)], "pressure labels") +=
        label_effects.col(j).array();
  }
  for (Index k = 0; k < n_levels; ++k) {
    const auto column = interpolation.col(k).array();
    if ((column == 0.0).all()) continue;
    table.effect("interpolation above " + curves.levels[static_cast<std::size_t>(k)].name,
                 "interpolation") += column;
  }
  if (gauge.gain > 0.0) {
    table.effect("gauge gain", "gauge gain") = reading.pressure * gauge.gain;
  }
  reading.uncertainty.independent = variance.sqrt();
  reading.uncertainty.modes = table.take();

  form_interval(reading, options.coverage);
  const Array1 standard = reading.uncertainty.standard();
  for (Index ix = 0; ix < n; ++ix) {
    if (!reading.answered(ix) || standard[ix] <= options.largest_uncertainty * range) continue;
    reading.flags[ix] |= ReadingFlag::insensitive;
    reading.pressure[ix] = reading.lower[ix] = reading.upper[ix] = reading.slope[ix] = 0.0;
    reading.uncertainty.independent[ix] = 0.0;
    for (ErrorMode& mode : reading.uncertainty.modes) mode.effect[ix] = 0.0;
  }
  return reading;
}

void form_interval(PressureReading& reading, double coverage) {
  const double factor = boost::math::quantile(boost::math::normal(), 0.5 * (1.0 + coverage));
  const Array1 standard = reading.uncertainty.standard();
  reading.lower = reading.pressure - factor * standard;
  reading.upper = reading.pressure + factor * standard;
}

}  // namespace manoscope::inversion
