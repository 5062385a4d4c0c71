#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "manoscope/core/monitor.hpp"
#include "manoscope/design/answer_wish.hpp"
#include "manoscope/design/choose_levels.hpp"
#include "manoscope/design/run_forecast.hpp"
#include "manoscope/design/what_matters.hpp"
#include "manoscope/design/wish.hpp"
#include "manoscope/twin/scenario_file.hpp"

namespace manoscope::design {

/// The wall and the reading of one pressure.
struct PlannedReading {
  double pressure = 0.0;    ///< Pa
  double deflection = 0.0;  ///< m, width-averaged, mid-channel
  double compliance = 0.0;  ///< m/Pa
  double uncertainty = 0.0, error = 0.0;
  std::vector<std::pair<std::string, double>> sources;  ///< standard uncertainty by source, Pa
};

/// Levels, and what they would leave of the uncertainty.
struct LevelSet {
  std::string name;
  std::vector<double> levels;  ///< Pa, repeats included
  RangeUncertainty over;
  double drop = 0.0;  ///< Pa, uncertainty of the drop over the range
  std::vector<RunForecast> runs;
};

/// What to do, and what to expect.
struct Plan {
  std::string name;
  PressureSpan range;  ///< that is read
  Aim aim = Aim::worst;
  LevelSet planned;
  std::vector<LevelSet> others;  ///< of the same number: log-spaced, even; and the scenario's own
  std::vector<PlannedReading> readings;
  std::vector<Improvement> improvements;
  std::vector<WishAnswer> answers;
  std::vector<std::string> notes;
  /// Whether p(x) is read through the wall's neighbourhood, as of a wall without snaps.
  bool through_wall = false;
  /// m, half-response wavelength of the wall: least and largest over the range; 0: answers to the
  /// pressure at x alone.
  PressureSpan half_wavelength;
  double smallest_gap = 0.0;  ///< m, crest of the wall at rest over the floor, mid-channel
  MapQuality maps;
  twin::Scenario scenario;  ///< with the planned levels
};

/// Plans the calibration of an experiment: how many levels, where, and what that leaves.
///
/// The wall is solved under uniform pressure and under the flow rates; what a map tells is found by
/// recording and reducing a few (rehearse_maps()); readings at mid-channel are forecast by the
/// measurement's own estimators (forecast_readings()), and levels are placed so that their
/// uncertainty over the range is least.
///
/// Range of validity: that of the wall's law; see forecast_readings() for what is left out. A wall
/// that snaps is planned for above its two states.
///
/// @param draft  its levels, if it has any, are compared.
/// @throws InputError if the wish is out of range or tells no range of pressure, if the wall
/// touches
///         the floor at rest or would rise beyond its theory, or if the channel chokes and no range
///         is given. Interrupted.
Plan make_plan(const twin::ScenarioDraft& draft, const Wish& wish, int n_threads = 0,
               const Monitor& monitor = {});

}  // namespace manoscope::design
