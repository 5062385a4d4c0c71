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

/// The slopes of the constitutive curves at the levels. Their standard uncertainty is that of the
/// slope of a parabola p(zeta) through a level and its neighbours (labels, planes, places and
/// pixels of the three, the gauge's gain), and the difference between both slopes: what
/// interpolation may do.
StationStiffness station_stiffness(const calibration::ConstitutiveCurves& curves,
                                   const GaugeErrors& gauge = {});

}  // namespace manoscope::inversion
