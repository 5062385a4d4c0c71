#include "manoscope/design/forecast.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "manoscope/calibration/fit_curves.hpp"
#include "manoscope/core/flags.hpp"
#include "manoscope/inversion/read_pressure.hpp"

namespace manoscope::design {
namespace {

/// A profile whose stations all show mid-channel.
Profile flat_profile(Array1 zeta, double noise, double leveling, const std::string& name) {
  Profile profile;
  const Index n = zeta.size();
  profile.x = Array1::LinSpaced(n, 0.0, 1.0);  // stands for nothing
  profile.zeta = std::move(zeta);
  profile.uncertainty.independent = Array1::Constant(n, noise);
  profile.uncertainty.modes.push_back(
      {"level plane of " + name, "leveling", Array1::Constant(n, leveling)});
  profile.flags = Flags1::Zero(n);
  return profile;
}

/// Stations that stand for a whole map: as many as estimate_labels() wants.
constexpr Index kStations = 5;

std::vector<calibration::Level> make_levels(const Apparatus& apparatus,
                                            const std::vector<double>& levels) {
  // The labels' estimate averages over the stations of a whole map.
  const double noise =
      apparatus.maps.station_noise *
      std::sqrt(static_cast<double>(kStations) / static_cast<double>(apparatus.maps.n_stations));
  std::vector<calibration::Level> made;
  for (std::size_t k = 0; k < levels.size(); ++k) {
    const std::string name = fmt::format("h{:03d}", k);
    const bool vented = levels[k] == 0.0;
    made.push_back({name, Pressure::from_si(levels[k]), vented ? Pressure{} : apparatus.gauge.noise,
                    flat_profile(Array1::Constant(kStations, apparatus.curve.deflection(levels[k])),
                                 noise, apparatus.maps.leveling, name),
                    vented ? 0.0 : 1.0});
  }
  return made;
}

/// The curves of a calibration, the same at n stations whose noise is that of one.
calibration::ConstitutiveCurves spread(calibration::ConstitutiveCurves curves,
                                       const Apparatus& apparatus, Index n) {
  curves.curves.assign(static_cast<std::size_t>(n), curves.curves.front());
  for (calibration::Level& level : curves.levels) {
    level.profile = flat_profile(Array1::Constant(n, level.profile.zeta[0]),
                                 apparatus.maps.station_noise, apparatus.maps.leveling, level.name);
  }
  curves.x = curves.levels.front().profile.x;
  return curves;
}

Profile make_state(const Apparatus& apparatus, const Array1& pressures) {
  const double fewer = 1.0 / std::sqrt(static_cast<double>(apparatus.flow_maps));
  const Index n = pressures.size();
  Array1 zeta(n), compliance(n);
  for (Index i = 0; i < n; ++i) {
    zeta[i] = apparatus.curve.deflection(pressures[i]);
    compliance[i] = apparatus.curve.compliance(pressures[i]);
  }
  Profile state = flat_profile(zeta, fewer * apparatus.maps.station_noise,
                               fewer * apparatus.maps.leveling, "flow map");
  state.uncertainty.modes.push_back(
      {"shift of flow map", "registration",
       fewer * apparatus.maps.flow_shift * apparatus.gradient * compliance});
  return state;
}

/// The curves as if their errors were those that labels really leave.
calibration::ConstitutiveCurves with_real_label_errors(calibration::ConstitutiveCurves curves) {
  Matrix labels = Matrix::Zero(curves.label_response.cols(), curves.label_response.cols());
  curves.label_error.clear();
  for (std::size_t k = 0; k < curves.levels.size(); ++k) {
    labels(static_cast<Index>(k), static_cast<Index>(k)) = curves.levels[k].uncertainty.si();
    curves.label_error.push_back("label of " + curves.levels[k].name);
  }
  curves.label_effect = curves.label_response * labels;
  return curves;
}

}  // namespace

bool Forecast::answered(Index i) const { return (flags[i] & ReadingFlag::no_answer) == 0; }

Array1 Forecast::uncertainty() const {
  Array1 larger = stated.standard().max(error.standard());
  for (Index i = 0; i < larger.size(); ++i) {
    if (!answered(i)) larger[i] = std::numeric_limits<double>::infinity();
  }
  return larger;
}

Forecast forecast_readings(const Apparatus& apparatus, const std::vector<double>& levels,
                           const Array1& pressures) {
  const auto curves = spread(calibration::expect_curves(make_levels(apparatus, levels)), apparatus,
                             pressures.size());
  const Profile state = make_state(apparatus, pressures);
  const inversion::GaugeErrors gauge{apparatus.gauge.gain_uncertainty,
                                     apparatus.gauge.zero_uncertainty};
  inversion::ReadPressureOptions options;
  options.largest_uncertainty = 1e9;  // the plan says what is too much

  auto reading = inversion::read_pressure(curves, state, gauge, options);
  const double left = std::sqrt(apparatus.averaging);
  auto real = inversion::read_pressure(with_real_label_errors(curves), state, gauge, options);
  Forecast forecast{pressures, reading.flags, std::move(reading.uncertainty),
                    std::move(real.uncertainty)};
  forecast.stated.independent *= left;
  forecast.error.independent *= left;
  std::erase_if(forecast.error.modes,
                [](const ErrorMode& mode) { return mode.source == "interpolation"; });
  forecast.error.modes.push_back({"curve", "curve shape", reading.pressure - pressures});
  return forecast;
}

Array1 by_source(const Uncertainty& uncertainty, const std::string& source) {
  if (source == "pixel noise") return uncertainty.independent;
  Array1 squares = Array1::Zero(uncertainty.independent.size());
  for (const ErrorMode& mode : uncertainty.modes) {
    if (mode.source == source) squares += mode.effect.square();
  }
  return squares.sqrt();
}

double difference(const Uncertainty& uncertainty, Index a, Index b) {
  double squares =
      std::pow(uncertainty.independent[a], 2) + std::pow(uncertainty.independent[b], 2);
  for (const ErrorMode& mode : uncertainty.modes) {
    squares += std::pow(mode.effect[a] - mode.effect[b], 2);
  }
  return std::sqrt(squares);
}

}  // namespace manoscope::design
