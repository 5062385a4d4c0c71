#pragma once

#include "manoscope/core/arrays.hpp"
#include "manoscope/core/grid.hpp"

namespace manoscope {

/// Deflection zeta(x, z) of the wall from the plane of the rigid rim, in the channel's frame.
///
/// Arrays have shape (nz, nx), row-major: a row runs along the flow. Unit: m. Positive away from
/// the fluid. A sample counts only where `flags` is 0 (bits of PixelFlag).
/// `noise` is the standard deviation of one pixel (k = 1), taken as equal for all of them;
/// `noise_length_x`, `noise_length_z` are the numbers of neighbouring pixels that share one
/// independent error along x and z (1 = white noise).
class DeflectionMap {
 public:
  /// @throws InternalError if a shape differs from the grid.
  DeflectionMap(ChannelGrid grid, Array2 zeta, Flags2 flags, Length noise,
                double noise_length_x = 1.0, double noise_length_z = 1.0);

  const ChannelGrid& grid() const { return grid_; }
  const Array2& zeta() const { return zeta_; }
  const Flags2& flags() const { return flags_; }
  Length noise() const { return noise_; }
  double noise_length_x() const { return noise_length_x_; }
  double noise_length_z() const { return noise_length_z_; }

 private:
  ChannelGrid grid_;
  Array2 zeta_;
  Flags2 flags_;
  Length noise_;
  double noise_length_x_, noise_length_z_;
};

}  // namespace manoscope
