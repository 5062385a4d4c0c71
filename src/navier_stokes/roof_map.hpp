#pragma once

#include "channel_shape.hpp"
#include "manoscope/core/arrays.hpp"
#include "manoscope/core/units.hpp"

namespace manoscope::navier_stokes {

/// Deflection of a wall that is clamped at both sides: a smooth surface through a map.
///
/// SmoothStencil along and across. A map whose z begin at the middle is half of a symmetric one.
/// Rows beyond the sides are left out; where the last row lies before a side, zeta = 0 there.
class RoofMap {
 public:
  /// @throws InputError if stations do not ascend or values are not finite, there are fewer than
  ///         four positions across, or the map ends farther than a tenth of the width from a side.
  RoofMap(const ShapeTable& table, Length width);

  const Array1& x() const { return table_.x; }
  const Array1& z() const { return table_.z; }  ///< from side to side
  const Array2& zeta() const { return table_.zeta; }
  double length() const { return table_.x[table_.x.size() - 1] - table_.x[0]; }
  /// zeta at x in [first station, last station] and z in [-w/2, w/2], m.
  double value(double x, double z) const;
  /// Its part that is even across: half the sum of both sides.
  double even(double x, double z) const { return 0.5 * (value(x, z) + value(x, -z)); }
  /// Width-averaged deflection along the channel.
  const ChannelShape& mean() const { return mean_; }
  /// Root mean square of the part that is odd across, m.
  double odd() const;

 private:
  ShapeTable table_;
  ChannelShape mean_;
};

/// @throws InputError naming the place of the smallest gap, if it is not open everywhere on the
///         map.
void require_open_gap(const RoofMap& roof, Length height);

}  // namespace manoscope::navier_stokes
