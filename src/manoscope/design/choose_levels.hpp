#pragma once

#include <functional>
#include <vector>

#include "manoscope/core/monitor.hpp"
#include "manoscope/design/place_levels.hpp"

namespace manoscope::design {

/// A level of a plan.
struct PlannedLevel {
  double pressure = 0.0;  ///< Pa
  int repeats = 1;        ///< maps, each with a label of its own
};

/// Equal neighbours counted.
std::vector<PlannedLevel> count_repeats(const std::vector<double>& levels);

/// Levels as someone would set them: those closer together than labels tell become repeats of their
/// mean, and pressures are rounded; neither by more than costs 1 % of what placing can change.
///
/// @param levels  of place_levels(), Pa, ascending.
std::vector<double> tidy_levels(const PlacementTask& task, const std::vector<double>& levels);

/// Levels that do, or the most that may be.
struct ChosenLevels {
  std::vector<double> levels;
  bool enough = false;
};

/// The fewest levels that do: numbers are tried in growing steps, then halved.
///
/// @param enough  whether levels do; that more do if fewer did is taken for granted.
/// @param most    5 or more.
/// @throws Interrupted if the monitor says so.
ChosenLevels fewest_levels(const PlacementTask& task, int most,
                           const std::function<bool(const std::vector<double>&)>& enough,
                           int n_threads = 0, const Monitor& monitor = {});

}  // namespace manoscope::design
