#pragma once

#include <vector>

#include "manoscope/core/arrays.hpp"
#include "manoscope/core/uncertainty.hpp"

namespace manoscope {

/// Width-averaged deflection zeta(x) of one map: value, uncertainty and flags travel together.
///
/// All arrays have shape (n_x). Units: m. A station counts only where `flags` is 0 (bits of
/// StationFlag); values elsewhere are 0 and mean nothing.
struct Profile {
  Array1 x;     ///< m, from the channel's inlet edge along the flow, ascending
  Array1 zeta;  ///< m, positive away from the fluid
  Uncertainty uncertainty;
  Flags1 flags;
};

/// Mean of repeats of the same state, station by station over those that count.
/// @param profiles  at least one, on the same stations.
Profile mean_profile(const std::vector<Profile>& profiles);

}  // namespace manoscope
