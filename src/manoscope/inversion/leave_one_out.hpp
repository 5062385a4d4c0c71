#pragma once

#include <vector>

#include "manoscope/calibration/fit_curves.hpp"
#include "manoscope/core/arrays.hpp"
#include "manoscope/inversion/test_section.hpp"

namespace manoscope::inversion {

/// One level read on the curves of the others.
struct LevelLeftOut {
  /// (n_x) Pa, what its map reads minus its label, and the standard uncertainty of that, the
  /// label's own error in it; NaN where the others have no answer.
  Array1 error, uncertainty;
  /// Mean over the stations with an answer, the errors they share taken as shared; NaN where fewer
  /// than half have one.
  double mean_error = 0.0, mean_uncertainty = 0.0;
};

/// Every level of a calibration left out in turn.
struct LeftOut {
  Array1 x;                          ///< (n_x) m
  std::vector<LevelLeftOut> levels;  ///< as those of the curves; the outermost have no numbers
};

/// What the calibration says of itself without any truth: each inner level's map is read on curves
/// made without it, and compared with its label.
///
/// A pull, error over uncertainty, has width 1 where labels, maps and interpolation are as
/// uncertain as stated. The interpolation spans twice the distance that it does in a measurement.
/// Neighbouring levels lean on each other's labels: their pulls are not independent.
///
/// @param stretch  stations in it count, about thirty of them.
/// @return without levels where fewer than four are there.
LeftOut leave_one_out(const calibration::ConstitutiveCurves& curves,
                      const calibration::FitCurvesOptions& options, const Stretch& stretch);

}  // namespace manoscope::inversion
