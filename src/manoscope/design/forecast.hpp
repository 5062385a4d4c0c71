#pragma once

#include <vector>

#include "manoscope/core/arrays.hpp"
#include "manoscope/core/uncertainty.hpp"
#include "manoscope/design/map_quality.hpp"
#include "manoscope/design/wall_survey.hpp"
#include "manoscope/twin/scenario.hpp"

namespace manoscope::design {

/// What a calibration is made with: wall, camera and gauge.
struct Apparatus {
  WallCurve curve;  ///< at mid-channel
  MapQuality maps;
  twin::GaugeOptions gauge;
  /// Share of a station's variance by pixel noise that is left in p(x): 1 where every station is
  /// read on its own, less where neighbours are read together.
  double averaging = 1.0;
  double gradient = 0.0;  ///< Pa/m, of p(x): what the position of a flow map is worth
  int flow_maps = 1;      ///< of one flow rate, averaged
};

/// What readings of given pressures are expected to be.
struct Forecast {
  Array1 pressure;  ///< (n) Pa, the true ones
  Flags1 flags;     ///< bits of ReadingFlag; entries with a bit of no_answer mean nothing
  /// What the measurement will state: pixel noise, leveling, registration, pressure labels,
  /// interpolation, gauge zero, gauge gain, each a source.
  Uncertainty stated;
  /// What it will be off by: the labels' errors as they really come through, and instead of the
  /// doubt of interpolation the error of the curve itself, a mode of source "curve shape".
  Uncertainty error;

  bool answered(Index i) const;
  /// (n) Pa: the larger of the two standard uncertainties; infinite without an answer.
  Array1 uncertainty() const;
};

/// Forecasts readings at mid-channel by the estimators of the measurement itself: expect_curves()
/// of the levels, read_pressure() of states at the given pressures.
///
/// Against drawn calibrations of a membrane and of a plate that follows no cubic: bars within 12 %,
/// errors within 20 %, the larger of both within 15 % of the errors.
///
/// Not in it: what a wall makes of a pressure that is not uniform (near its ends, and where p(x)
/// bends), and errors of single maps that no uncertainty knows of, such as patches of a false
/// fringe order.
///
/// @param levels     Pa, ascending, 3 distinct or more; equal ones are repeats. 0 is vented to air.
/// @param pressures  (n) Pa.
/// @throws InputError as sort_levels().
Forecast forecast_readings(const Apparatus& apparatus, const std::vector<double>& levels,
                           const Array1& pressures);

/// Standard uncertainty by one source: (n) Pa.
Array1 by_source(const Uncertainty& uncertainty, const std::string& source);

/// Standard uncertainty, Pa, of the difference of two of the readings.
double difference(const Uncertainty& uncertainty, Index a, Index b);

}  // namespace manoscope::design
