#pragma once

#include <cmath>
#include <optional>

#include "manoscope/core/deflection_map.hpp"
#include "manoscope/core/units.hpp"

namespace manoscope::maps {

/// Where the middle between the wall's two sides runs: z = offset + slope (x - length / 2).
struct CentreLine {
  Length offset{};
  double slope = 0.0;  ///< m/m: the angle to the frame's axis
  Length offset_uncertainty{};
  double slope_uncertainty = 0.0;

  double z(double x, double length) const { return offset.si() + slope * (x - 0.5 * length); }
  /// Its farthest distance from z = 0 over the channel.
  double farthest(double length) const {
    return std::abs(offset.si()) + 0.5 * length * std::abs(slope);
  }
};

/// Finds it from the sides of the wall, where it begins to move.
///
/// In twelve stretches along the channel the mean profile across passes the fractions f = 0.15 ...
/// 0.6 of its height on either side; the middle between the two, extrapolated to f = 0 by a
/// straight line in f, is the stretch's middle (a wall that leans to one side between fixed edges
/// moves the middle at greater f). A straight line is laid through the stretches by least squares;
/// its uncertainty holds their scatter.
///
/// Source: our own. Accuracy on membranes and plates 1 mm wide, pixels of 8 um: 0.1 um.
/// @return none where fewer than four stretches show a wall that rises above ten deviations of
/// their noise, or the wall's sides are not in the map.
std::optional<CentreLine> find_centre_line(const DeflectionMap& map, Length length, Length width);

}  // namespace manoscope::maps
