#include "manoscope/validation/wall_answer.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "manoscope/core/error.hpp"
#include "manoscope/core/flags.hpp"
#include "manoscope/numerics/robust.hpp"

namespace manoscope::validation {

using calibration::ConstitutiveCurve;

CurvedWall::CurvedWall(const calibration::ConstitutiveCurves& curves, Length length,
                       double largest_extrapolation)
    : curves_(curves), extrapolation_(largest_extrapolation) {
  Profile with_curve;
  with_curve.x = curves.x;
  with_curve.zeta = Array1::Zero(curves.x.size());
  with_curve.flags = Flags1::Zero(curves.x.size());
  std::vector<double> lowest, highest;
  for (Index ix = 0; ix < curves.x.size(); ++ix) {
    const auto& own = curves.curves[static_cast<std::size_t>(ix)];
    if (!own || curves.x[ix] < 0.0 || curves.x[ix] > length.si()) continue;
    lowest.push_back(own->lowest());
    highest.push_back(own->highest());
  }
  const auto refuse_if = [](bool none) {
    if (!none) return;
    throw InputError("constitutive curves", "no station inside the channel has a curve",
                     "Check the channel's length and the calibration");
  };
  refuse_if(lowest.empty());
  const double low_end = numerics::median(lowest), high_end = numerics::median(highest);
  const double allowed = largest_extrapolation * (high_end - low_end);
  for (Index ix = 0; ix < curves.x.size(); ++ix) {
    const auto& own = curves.curves[static_cast<std::size_t>(ix)];
    const bool counts =
        own && own->lowest() <= low_end + allowed && own->highest() >= high_end - allowed;
    with_curve.flags[ix] = counts ? 0 : StationFlag::no_data;
  }
  refuse_if((with_curve.flags != 0).all());
  const WallLine line = wall_line(with_curve, length);
  x_ = line.x;
  station_ = line.station;
  for (Index i = 0; i < size(); ++i) {
    const ConstitutiveCurve* const own = curve(i);
    if (own == nullptr) continue;
    const double span = own->zeta(own->highest()) - own->zeta(own->lowest());
    largest_span_ = std::max(largest_span_, std::abs(span));
  }
  for (Index i = 0; i < size(); ++i) {
    const ConstitutiveCurve* const own = curve(i);
    if (own == nullptr) continue;
    const double low = own->lowest() - room(*own, own->lowest());
    const double high = own->highest() + room(*own, own->highest());
    for (const double p : {low, own->lowest(), own->highest(), high}) {
      least_ = std::min(least_, zeta(i, p));
      greatest_ = std::max(greatest_, zeta(i, p));
    }
  }
}

const ConstitutiveCurve* CurvedWall::curve(Index i) const {
  const Index ix = station_[static_cast<std::size_t>(i)];
  return ix == kClampedEnd ? nullptr : &*curves_.curves[static_cast<std::size_t>(ix)];
}

double CurvedWall::room(const ConstitutiveCurve& curve, double end) const {
  const double slope = std::abs(curve.slope(end)), range = curve.highest() - curve.lowest();
  return extrapolation_ * (slope * range > largest_span_ ? largest_span_ / slope : range);
}

double CurvedWall::zeta(Index i, double pressure) const {
  const ConstitutiveCurve* const own = curve(i);
  if (own == nullptr) return 0.0;
  const double inside = std::clamp(pressure, own->lowest(), own->highest());
  if (inside == pressure) return own->zeta(inside);
  const double most = room(*own, inside);
  return own->zeta(inside) + own->slope(inside) * std::clamp(pressure - inside, -most, most);
}

double CurvedWall::slope(Index i, double pressure) const {
  const ConstitutiveCurve* const own = curve(i);
  if (own == nullptr || beyond(i, pressure) > 0.0) return 0.0;
  return own->slope(std::clamp(pressure, own->lowest(), own->highest()));
}

bool CurvedWall::is_outside(Index i, double pressure) const {
  const ConstitutiveCurve* const own = curve(i);
  return own != nullptr && (pressure < own->lowest() || pressure > own->highest());
}

double CurvedWall::beyond(Index i, double pressure) const {
  const ConstitutiveCurve* const own = curve(i);
  if (own == nullptr) return 0.0;
  const double inside = std::clamp(pressure, own->lowest(), own->highest());
  if (inside == pressure) return 0.0;
  return std::max(0.0, std::abs(pressure - inside) - room(*own, inside));
}

double CurvedWall::lowest(Index i) const {
  const ConstitutiveCurve* const own = curve(i);
  return own == nullptr ? -std::numeric_limits<double>::infinity() : own->lowest();
}

double CurvedWall::highest(Index i) const {
  const ConstitutiveCurve* const own = curve(i);
  return own == nullptr ? std::numeric_limits<double>::infinity() : own->highest();
}

WallLine CurvedWall::line(const Array1& pressure) const {
  WallLine line{x_, Array1(size()), station_};
  for (Index i = 0; i < size(); ++i) line.zeta[i] = zeta(i, pressure[i]);
  return line;
}

Uncertainty CurvedWall::errors(const Array1& pressure, const inversion::GaugeErrors& gauge) const {
  // The errors of a reading of these very deflections, turned round: dzeta = -slope dp.
  Profile state;
  state.x = curves_.x;
  state.zeta = Array1::Zero(curves_.x.size());
  state.uncertainty.independent = state.zeta;
  state.flags = Flags1::Constant(curves_.x.size(), StationFlag::no_data);
  for (Index i = 0; i < size(); ++i) {
    const ConstitutiveCurve* const own = curve(i);
    if (own == nullptr) continue;
    // A little inside, so that round-off does not put the deflection beyond the curve's end.
    const double edge = 1e-9 * (own->highest() - own->lowest());
    const Index ix = station_[static_cast<std::size_t>(i)];
    state.zeta[ix] =
        own->zeta(std::clamp(pressure[i], own->lowest() + edge, own->highest() - edge));
    state.flags[ix] = 0;
  }
  inversion::ReadPressureOptions options;
  options.ambiguity_reach = 0.0;
  options.largest_uncertainty = 1e6;  // ranges: every error counts here
  const inversion::PressureReading reading =
      inversion::read_pressure(curves_, state, gauge, options);
  Uncertainty errors;
  errors.independent = Array1::Zero(size());
  Array1 slopes(size());
  for (Index i = 0; i < size(); ++i) slopes[i] = slope(i, pressure[i]);
  const auto on_wall = [&](const Array1& effect) {
    Array1 result(size());
    for (Index i = 0; i < size(); ++i) {
      const Index ix = station_[static_cast<std::size_t>(i)];
      result[i] = ix == kClampedEnd ? 0.0 : -slopes[i] * effect[ix];
    }
    return result;
  };
  errors.independent = on_wall(reading.uncertainty.independent).abs();
  for (const ErrorMode& mode : reading.uncertainty.modes) {
    errors.modes.push_back({mode.variable, mode.source, on_wall(mode.effect)});
  }
  return errors;
}

}  // namespace manoscope::validation
