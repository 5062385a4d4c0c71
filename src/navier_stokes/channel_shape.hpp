#pragma once

#include <filesystem>

#include "manoscope/core/arrays.hpp"
#include "smooth_stencil.hpp"

namespace manoscope::navier_stokes {

/// Deflection of a wall as a table holds it: width-averaged along the channel, or a map.
struct ShapeTable {
  Array1 x;     ///< (n_x) m, strictly ascending
  Array1 z;     ///< (n_z) m, strictly ascending, 0 in the middle; empty: zeta is width-averaged
  Array2 zeta;  ///< (n_x, n_z) m; (n_x, 1) where z is empty

  bool is_map() const { return z.size() > 0; }
};

/// Reads a table with the columns `x` and `zeta`, and `z` for a map, each with a unit of length in
/// the header; the rows of a map in any order, one for every x at every z.
/// @throws InputError naming file and line, or the place of a map that has no row or two.
ShapeTable read_shape_table(const std::filesystem::path& path);

/// Width-averaged deflection along a channel: a smooth curve through its stations (SmoothStencil).
class ChannelShape {
 public:
  /// @param x     (n) stations, m, strictly ascending, n >= 2.
  /// @param zeta  (n) width-averaged deflection, m.
  /// @throws InputError if they do not ascend, differ in number or are not finite.
  ChannelShape(Array1 x, Array1 zeta);

  const Array1& x() const { return x_; }
  const Array1& zeta() const { return zeta_; }
  double length() const { return x_[x_.size() - 1] - x_[0]; }
  /// zeta at x in [first station, last station], m.
  double value(double x) const { return SmoothStencil(x_, x).value(zeta_); }

 private:
  Array1 x_, zeta_;
};

}  // namespace manoscope::navier_stokes
