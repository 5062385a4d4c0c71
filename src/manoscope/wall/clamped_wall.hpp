#pragma once

#include <functional>

#include "manoscope/core/arrays.hpp"
#include "manoscope/core/units.hpp"
#include "manoscope/wall/tapered_membrane.hpp"
#include "manoscope/wall/wall_section.hpp"

namespace manoscope::wall {

/// Stress-free shape of a wall that is not quite flat, counted from the plane of the rim:
///
///   zeta0(x, z) = crest A(x) A(l - x) (1 + lopsidedness (x/l - 1/2)) (1 - (2 z/w)^2)^2,
///   A(d) = 1 - (1 + d/L) e^(-d/L),  L = w/pi.
///
/// It has no slope at the clamped edges. A negative crest starts a buckled wall downward.
struct InitialShape {
  Length crest{};
  double lopsidedness = 0.0;  ///< in [-2, 2]
};

/// Crest over half the (shorter) width up to which the shallow walls of this module are used.
///
/// Foeppl and von Karman count rotations as moderate: the arc of a parabola of rise k = crest/a is
/// a (1 + 2/3 k^2 - 2/5 k^4 + ...), of which they keep the square. At 0.4 the stretching is off by
/// 3/5 k^2 = 10 % of itself, and the edge of a stretched wall leans by 2 k = 39 degrees, where a
/// pressure normal to the plane is no longer normal to the wall; at 0.2 it is off by 2.4 %.
inline constexpr double kLargestRise = 0.4;

/// A rectangular elastic wall clamped all round.
struct ClampedWall {
  Length length{};                ///< l, along x in [0, l]
  Length width{};                 ///< w, along z in [-w/2, w/2]
  Length thickness{};             ///< t
  Pressure youngs_modulus{};      ///< E
  double poisson_ratio = 0.0;     ///< nu, in (-1, 0.5]
  Pressure prestress{};           ///< s0, isotropic in-plane; tension positive, either sign
  double shear_correction = 0.0;  ///< kappa, e.g. 5/6; 0 = rigid in shear (thin plate)
  Preload preload{};              ///< inward load that its clamping leaves in it
  InitialShape initial_shape{};
  /// False: the edges hold the wall in its plane both ways, as a bonded rim does. True: they hold
  /// it across but let it slide along them without friction, as in Levy's (1942) plate.
  bool sliding_edges = false;

  /// @throws InputError naming the first property out of range.
  void validate() const;
  /// What the laws of a long wall (PlateStrip) see of it.
  WallSection section() const {
    return {width, thickness, youngs_modulus, poisson_ratio, prestress, shear_correction};
  }
  /// Bending stiffness D = E t^3/(12 (1 - nu^2)), N m.
  double bending_stiffness() const { return section().bending_stiffness(); }
  /// sqrt(D/N), m: the clamped edge layer at a pressure, N the mid-channel tension of a long wall
  /// there; a/2 where bending carries the load.
  double edge_layer(Pressure pressure) const;
  /// Uniform pressure that brings the crest of the flat wall to kLargestRise of half its shorter
  /// side: the strip's law (PlateStrip) times 1 + (shorter/longer side)^4. An estimate, within 10 %
  /// between a square and a strip; compression is left out.
  Pressure largest_pressure() const;
};

/// Gauge pressure on a wall: uniform, along the flow, or any.
class WallLoad {
 public:
  static WallLoad uniform(Pressure pressure);
  /// p(x) through stations, linear between them, constant beyond the first and the last.
  /// @param x  (n) m, strictly ascending.  @param pressure  (n) Pa.
  /// @throws InputError if the shapes differ, are empty, unsorted or not finite.
  static WallLoad along(Array1 x, Array1 pressure);
  /// p(x, z) in Pa, x in [0, l], z in [-w/2, w/2], in m; smooth within the cells of the grid.
  static WallLoad field(std::function<double(double, double)> pressure);
  /// This load and a share of another on top.
  /// @throws InputError unless both have the same stations; a uniform load goes with any stations.
  WallLoad plus(double share, const WallLoad& other) const;

  const Array1& x() const { return x_; }
  const Array1& pressure() const { return pressure_; }
  const std::function<double(double, double)>& field() const { return field_; }

 private:
  Array1 x_, pressure_;
  std::function<double(double, double)> field_;
};

}  // namespace manoscope::wall
