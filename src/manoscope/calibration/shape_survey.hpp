#pragma once

#include "manoscope/calibration/shape_stretch.hpp"
#include "manoscope/core/arrays.hpp"
#include "manoscope/core/cross_sections.hpp"

namespace manoscope::calibration {

/// A map whose cross-sections are to be judged, or to judge by.
struct ShapedMap {
  double pressure = 0.0;          ///< Pa, of a hydrostatic map; else not looked at
  const CrossSections* sections;  ///< of the same cells as those of all other maps; outlives this
  /// m: how far the wall of this map lies downstream in its cells, and the standard uncertainty.
  double shift = 0.0, shift_uncertainty = 0.0;
};

/// A map and what the check needs of it in all stretches. NaN where fewer than 70 % of the bins are
/// good.
struct SurveyedMap {
  ShapedMap map;
  /// (n_z, n_x) m, the cells; the bad ones by the cubic across through the two good ones on either
  /// side, the edges of the wall with zeta = 0 among them.
  Array2 whole;
  Array1 average;    ///< (n_x) m, of them
  Array1 curvature;  ///< (n_x) 1/m, of the average along x, by a parabola through five stretches
};

/// @param width  of the channel, m.
SurveyedMap survey(const ShapedMap& map, double width);

/// d zeta / dz of bin means, m per m: between the values at the bins' edges, each by the cubic that
/// has the means of the four bins about it.
/// @param zeta  (n) m, n >= 4.
BinVector slope_across(const BinVector& zeta, double bin_width);

}  // namespace manoscope::calibration
