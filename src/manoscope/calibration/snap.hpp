#pragma once

#include <optional>
#include <vector>

#include "manoscope/calibration/levels.hpp"

namespace manoscope::calibration {

/// The first level after a snap-through: the wall's state has jumped since the level before.
///
/// The state is the deflection projected on its whole change, and a jump a rise per pascal that is
/// eight times those of the steps before and behind; levels that their labels do not tell apart
/// count as one. Of several the last counts: above it the wall
/// is on one branch of states.
///
/// @param levels  ascending in pressure, on the same stations.
/// @return none where nothing jumps, no two levels lie behind, or the levels are in another order.
std::optional<Index> level_after_snap(const std::vector<Level>& levels);

}  // namespace manoscope::calibration
