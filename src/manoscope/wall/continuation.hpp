#pragma once

#include <vector>

#include "manoscope/wall/foppl_von_karman.hpp"

namespace manoscope::wall {

/// A jump of a wall from the end of one branch of equilibria to another.
struct SnapThrough {
  Pressure pressure{};     ///< last pressure at which `before` was still found to stand
  Pressure uncertainty{};  ///< the branch ends within this distance further on
  WallState before, after;
};

/// States of a wall under a pressure that changes slowly.
struct LoadPath {
  Array1 pressure;                 ///< (n) Pa, as asked for
  std::vector<WallState> states;   ///< n, each standing
  std::vector<SnapThrough> snaps;  ///< in the order met; empty if the whole path is one branch
};

/// Options of follow_pressure().
struct FollowOptions {
  /// A branch end is located to this share of the largest step between the pressures asked for.
  double resolution = 1e-3;
};

/// Follows a wall quasi-statically through a sequence of uniform pressures.
///
/// Each step is predicted along the tangent and corrected by Newton's method; it is taken if the
/// new state stands (no negative pivot of the tangent) and the step in volume agrees with the
/// trapezoid rule between both tangents, and the same step backwards returns; else it is halved.
/// Where no step remains the branch has ended at a limit or bifurcation point: the wall goes
/// downhill in energy to another state, and the jump is reported. Past a limit point the path
/// depends on direction: raising and lowering the pressure differ (hysteresis).
///
/// @param start  A standing state at pressures.front(), e.g. of FopplVonKarman::equilibrium().
/// @param pressures  (n) Pa, n >= 1, finite, in the order they are applied, rising or falling.
/// @throws InputError if a pressure is not finite, there is none, or no state can be found.
LoadPath follow_pressure(const FopplVonKarman& wall, const WallState& start,
                         const Array1& pressures, const FollowOptions& options = {});

}  // namespace manoscope::wall
