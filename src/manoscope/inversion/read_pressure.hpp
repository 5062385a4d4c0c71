#pragma once

#include <vector>

#include "manoscope/calibration/constitutive_curves.hpp"
#include "manoscope/core/arrays.hpp"
#include "manoscope/core/profile.hpp"
#include "manoscope/core/uncertainty.hpp"
#include "manoscope/core/units.hpp"

namespace manoscope::inversion {

/// Errors of the gauge that all calibration levels share.
struct GaugeErrors {
  double gain = 0.0;  ///< relative standard uncertainty
  Pressure zero{};    ///< standard uncertainty; levels vented to air do not have it
};

struct ReadPressureOptions {
  double coverage = 0.95;  ///< probability content of the interval
  /// A reading whose standard uncertainty exceeds this share of the calibrated range is no answer.
  double largest_uncertainty = 0.1;
  /// Two pressures count as possible if both lie within this many standard uncertainties of zeta.
  double ambiguity_reach = 2.0;

  template <class Visitor>
  void describe(Visitor&& visit) {
    visit("coverage", coverage, "probability content of the reported interval, in (0, 1)");
    visit("largest-uncertainty", largest_uncertainty,
          "largest standard uncertainty of a reading, as a share of the calibrated range");
    visit("ambiguity-reach", ambiguity_reach,
          "a second pressure within this many standard uncertainties of zeta makes it ambiguous");
  }
  /// @throws InputError naming the first option out of range.
  void validate() const;
};

/// p(x) of one state of the wall. Arrays have shape (n_x), units Pa.
///
/// Where `flags` holds a bit of ReadingFlag::no_answer there is no reading: pressure, slope and
/// every uncertainty are 0 there and mean nothing.
struct PressureReading {
  Array1 x;  ///< m
  Array1 pressure;
  Uncertainty uncertainty;
  Array1 lower, upper;  ///< ends of the coverage interval
  Array1 slope;         ///< m/Pa, d zeta / d p of the curve at the reading
  Flags1 flags;         ///< bits of ReadingFlag

  bool answered(Index ix) const;
};

/// Reads p(x) off the constitutive curves: the p for which zeta(x; p) equals the deflection.
///
/// Source: the method of Ozsun et al. 2013, section III C, at every station instead of at
/// crossings. Each station is read on its own; a wall under tension smooths pressure along x over
/// about w/pi, so that a reading near a clamped end, or of a p(x) that bends within that length, is
/// off by more than its stated uncertainty (inside, by p'' w^2/pi^2 at most).
///
/// Uncertainty, to first order (GUM): noise of both maps; and as modes shared along x the planes
/// and positions of all maps, the label of every level, gain and zero of the gauge,
/// and the doubt of interpolation between levels. The interval is
/// symmetric normal. Valid where the curve is nearly straight over one standard uncertainty.
///
/// @param state  deflection profile on the same stations as the curves.
/// @throws InputError if the stations differ, or an option is out of range.
PressureReading read_pressure(const calibration::ConstitutiveCurves& curves, const Profile& state,
                              const GaugeErrors& gauge = {},
                              const ReadPressureOptions& options = {});

/// Forms lower and upper anew from the standard uncertainty: symmetric, normal.
void form_interval(PressureReading& reading, double coverage);

}  // namespace manoscope::inversion
