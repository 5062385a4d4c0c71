#pragma once

#include <vector>

#include "manoscope/wall/foppl_von_karman.hpp"

namespace manoscope::wall {

/// Options of follow_load() and follow_pressure().
struct FollowOptions {
  /// A branch end is located to this share of the step (of the largest, in a sequence).
  double resolution = 1e-3;

  /// @throws InputError if the resolution is not in (0, 0.5].
  void validate() const;
};

/// A jump of a wall from the end of one branch of equilibria to another, on the way between loads.
struct BranchEnd {
  double share = 0.0;        ///< of the way, the last at which `before` was still found to stand
  double uncertainty = 0.0;  ///< the branch ends within this share further on
  WallState before, after;
};

/// A wall at the end of a slow change of its load.
struct FollowedLoad {
  WallState state;              ///< standing
  std::vector<BranchEnd> ends;  ///< in the order met; empty if the way is one branch
};

/// Follows a wall quasi-statically while its load changes in proportion from one to another.
///
/// Each step is predicted along the tangent and corrected by Newton's method; it is taken if the
/// new state stands (no negative pivot of the tangent), the work of the change agrees with the
/// trapezoid rule between both tangents, and the same step backwards returns; else it is halved. A
/// change below a thousand times the tolerance of a solution is one step, if the new state stands.
/// Where no step remains the branch has ended at a limit or bifurcation point: the wall goes
/// downhill in energy to another state, and the jump is reported. Past a limit point the path
/// depends on direction: raising and lowering the load differ (hysteresis).
///
/// @param start  A standing state under `from`, e.g. of FopplVonKarman::equilibrium().
/// @param from, to  Loads with the same stations, or one of them uniform.
/// @throws InputError if the loads do not go together or no state can be found.
/// @throws Interrupted if the wall's monitor says so.
FollowedLoad follow_load(const FopplVonKarman& wall, const WallState& start, const WallLoad& from,
                         const WallLoad& to, const FollowOptions& options = {});

/// A jump of a wall under uniform pressure.
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

/// Follows a wall through a sequence of uniform pressures by follow_load().
///
/// @param start  A state from which the one at pressures.front() is reached downhill in energy.
/// @param pressures  (n) Pa, n >= 1, finite, in the order they are applied, rising or falling.
/// @throws InputError if a pressure is not finite, there is none, or no state can be found.
LoadPath follow_pressure(const FopplVonKarman& wall, const WallState& start,
                         const Array1& pressures, const FollowOptions& options = {});

}  // namespace manoscope::wall
