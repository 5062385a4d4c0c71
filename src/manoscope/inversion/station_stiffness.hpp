#pragma once

#include "manoscope/calibration/constitutive_curves.hpp"
#include "manoscope/core/arrays.hpp"
#include "manoscope/inversion/read_pressure.hpp"

namespace manoscope::inversion {

/// Stiffness a(x) = dp/dzeta of every station at every level, the pressure rising everywhere alike:
/// as the calibration has it, ends included.
struct StationStiffness {
  Array2 value, uncertainty;  ///< (n_levels, n_x) Pa/m; NaN where the curve does not rise
};

/// The slopes of the constitutive curves at the levels, each with the standard uncertainty of the
/// secant through the neighbouring levels: their labels, planes, places and pixels, and the gauge's
/// gain. What interpolation does to a slope is not in it.
StationStiffness station_stiffness(const calibration::ConstitutiveCurves& curves,
                                   const GaugeErrors& gauge = {});

}  // namespace manoscope::inversion
