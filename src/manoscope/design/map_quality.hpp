#pragma once

#include <string>

#include "manoscope/core/index.hpp"
#include "manoscope/design/wall_survey.hpp"
#include "manoscope/twin/scenario.hpp"

namespace manoscope::design {

/// What maps of a camera tell of a wall's profile.
struct MapQuality {
  Index n_stations = 0;
  double spacing = 0.0;  ///< m, between stations
  double station_noise =
      0.0;                  ///< m, of one station's zeta by pixel noise; median of the middle half
  double leveling = 0.0;    ///< m, of zeta at mid-channel by the rim's plane; standard
  double flow_shift = 0.0;  ///< m, standard uncertainty of a flow map's position along the flow
  double missing = 0.0;     ///< share of pixels without a height
};

/// Records four maps with the camera of a scenario and reduces them as a measurement would: three
/// uniform pressures up to the highest one, and p(x) that falls from the highest to the lowest.
///
/// Seeded: the same scenario gives the same numbers. What falls out of a single draw (how many
/// pixels are lost where) moves them by a few percent.
/// @throws InputError where the maps cannot be reduced, such as without a rim.
MapQuality rehearse_maps(const twin::Scenario& scenario, const WallSurvey& survey,
                         const PressureSpan& range);

}  // namespace manoscope::design
