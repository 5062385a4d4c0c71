#pragma once

#include "manoscope/calibration/shape_check.hpp"

namespace manoscope::calibration {

/// One map's cross-sections in a few numbers, over a stretch of the channel.
struct ShapeVerdict {
  double chi_square = 0.0, dof = 0.0;  ///< sums; dof 0: nothing was compared
  /// How often chance makes as large a misfit: of the sum over all stretches and of the worst among
  /// them, each counted twice since two are looked at.
  double p_value = 1.0;
  double worst_start = 0.0, worst_end = 0.0;  ///< m, the worst stretch with those beside it
  double reading_shift = 0.0;                 ///< Pa, the largest there
};

/// @param x  (n) m, middles of the stretches; those within [start, end] count.
ShapeVerdict shape_verdict(const ShapeMisfit& misfit, const Array1& x, double start, double end);

}  // namespace manoscope::calibration
