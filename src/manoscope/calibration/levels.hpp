#pragma once

#include <string>
#include <vector>

#include "manoscope/core/profile.hpp"
#include "manoscope/core/units.hpp"

namespace manoscope::calibration {

/// The wall at one known uniform pressure.
///
/// The stations of the profile may be positions along a channel or any other labelled set (pixels
/// of a bulge): calibration and reading treat each on its own.
struct Level {
  std::string name;        ///< of the reading, unique: its label error is one error variable
  Pressure pressure{};     ///< as read on the gauge
  Pressure uncertainty{};  ///< standard, of this one reading alone; 0 = taken as exact
  Profile profile;         ///< zeta(x; pressure)
  /// Share of the label that was read on the gauge and so has its zero error: 0 for a map vented to
  /// air, which is at exactly 0 Pa; in between for the mean of repeats of both kinds.
  double gauge_share = 1.0;
};

/// Levels in ascending order of pressure, equal ones by name.
/// @throws InputError for stations that differ between levels.
std::vector<Level> order_levels(std::vector<Level> levels);

/// Levels in ascending order of pressure; those read at the same pressure become one.
///
/// Repeats are averaged with equal weight, station by station over the profiles that count; the
/// label of n repeats has 1/sqrt(n) of their uncertainty.
/// @throws InputError for fewer than 3 distinct pressures, or stations that differ between levels.
std::vector<Level> sort_levels(std::vector<Level> levels);

}  // namespace manoscope::calibration
