#include "manoscope/validation/wall_answer.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "manoscope/core/error.hpp"
#include "manoscope/core/flags.hpp"

namespace manoscope::validation {

using calibration::ConstitutiveCurve;

CurvedWall::CurvedWall(const calibration::ConstitutiveCurves& curves, Length length,
                       double largest_extrapolation)
    : curves_(curves), extrapolation_(largest_extrapolation) {
  Profile with_curve;
  with_curve.x = curves.x;
  with_curve.zeta = Array1::Zero(curves.x.size());
  with_curve.flags = Flags1::Zero(curves.x.size());
  bool any = false;
  for (Index ix = 0; ix < curves.x.size(); ++ix) {
    const bool has = curves.curves[static_cast<std::size_t>(ix)].has_value();
    with_curve.flags[ix] = has ? 0 : StationFlag::no_data;
    any = any || (has && curves.x[ix] >= 0.0 && curves.x[ix] <= length.si());
  }
  if (!any) {
    throw InputError("constitutive curves", "no station inside the channel has a curve",
                     "Check the channel's length and the calibration");
  }
  const WallLine line = wall_line(with_curve, length);
  x_ = line.x;
  station_ = line.station;
  for (Index i = 0; i < size(); ++i) {
    const ConstitutiveCurve* const own = curve(i);
    if (own == nullptr) continue;
    const double low = own->lowest() - room(*own), high = own->highest() + room(*own);
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

double CurvedWall::room(const ConstitutiveCurve& curve) const {
  return extrapolation_ * (curve.highest() - curve.lowest());
}

double CurvedWall::zeta(Index i, double pressure) const {
  const ConstitutiveCurve* const own = curve(i);
  if (own == nullptr) return 0.0;
  const double inside = std::clamp(pressure, own->lowest(), own->highest());
  const double beyond = std::clamp(pressure - inside, -room(*own), room(*own));
  return own->zeta(inside) + (beyond == 0.0 ? 0.0 : own->slope(inside) * beyond);
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
  return std::max(0.0, std::abs(pressure - inside) - room(*own));
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
