#pragma once

#include <optional>
#include <vector>

#include "manoscope/calibration/fit_curves.hpp"
#include "manoscope/inversion/test_section.hpp"

namespace manoscope::inversion {

/// Levels reached by a rising pressure against those reached by a falling one.
struct SweepComparison {
  int n_up = 0, n_down = 0;  ///< maps
  /// Pa: pressure on the way down minus that on the way up at which the wall deflects alike, mean
  /// over the maps of the way down; negative where a wall lags behind the pressure.
  double difference = 0.0;
  double uncertainty = 0.0;  ///< Pa, standard
};

/// Is there hysteresis: does the wall know which way it came?
///
/// A map counts for the way down if the pressure of the map before it was higher, else for the way
/// up. Curves are made of the way up alone, and every map of the way down that has a pressure
/// within theirs is read on them, mean over the stretch. Labels of both ways, maps and
/// interpolation are in the uncertainty, shared errors as shared.
///
/// @param levels  in the order in which they were taken.
/// @return none with fewer than four pressures on the way up or three maps on the way down.
std::optional<SweepComparison> compare_sweeps(const std::vector<calibration::Level>& levels,
                                              const calibration::FitCurvesOptions& options,
                                              const Stretch& stretch);

}  // namespace manoscope::inversion
