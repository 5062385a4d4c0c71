#pragma once

#include <filesystem>
#include <functional>

#include "manoscope/core/arrays.hpp"

namespace manoscope::navier_stokes {

/// Measured deflection along a channel: a smooth curve through its stations.
///
/// Cubic Hermite between neighbours, the slope at a station that of the parabola of fourth degree
/// through the five nearest (all, where there are fewer): C1, exact for polynomials of third
/// degree, error of order spacing^4 for smooth shapes. Noise is not smoothed away.
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
  double value(double x) const;

 private:
  Array1 x_, zeta_, slope_;
};

/// Reads a table with the columns `x` and `zeta`, both with a unit of length in the header.
/// @throws InputError naming file and line.
ChannelShape read_channel_shape(const std::filesystem::path& path);

}  // namespace manoscope::navier_stokes
