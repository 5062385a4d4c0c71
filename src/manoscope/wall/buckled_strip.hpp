#pragma once

#include <optional>

#include "manoscope/core/units.hpp"
#include "manoscope/wall/wall_section.hpp"

namespace manoscope::wall {

/// Pressures that end the state of a buckled strip that is bowed against them.
struct StripSnap {
  Pressure limit{};  ///< of the even state: beyond it there is none
  /// Where the even state gives way sideways, to an odd shape, before its limit; none where the
  /// strip is buckled too little for that.
  std::optional<Pressure> bifurcation{};

  /// What the strip bears: the lower of the two.
  Pressure bears() const { return bifurcation.value_or(limit); }
};

/// Snap-through of a long clamped plate strip under compression, bowed towards the fluid.
///
/// With n0 = s0 t a^2/D < -pi^2 the equilibria of the strip under p = P D t/a^4 obey
///
///   n - n0 = 12 P^2 h(n),   h of StripBending; n in (-4 pi^2, -pi^2) while bowed against p.
///
/// P is largest where h = (n - n0) h'; the odd shape appears at n = -20.19, the first root of
/// tan(sqrt(-n)) = sqrt(-n). Far above the buckling load (-n0 >> 40) both go as the square root of
/// the compression, P = sqrt(-n0/(12 h)): bending holds what is left, and little of it.
///
/// Source: StripBending (Timoshenko & Woinowsky-Krieger, ch. 1) continued below the buckling load.
/// Exact for the strip; a wall of finite length or with folds along it gives way no later.
///
/// @param section  without shear; prestress below PlateStrip::buckling_prestress().
/// @throws InputError if the strip is not buckled, shears, or is no wall.
StripSnap strip_snap(const WallSection& section);

}  // namespace manoscope::wall
