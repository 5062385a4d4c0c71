#pragma once

#include "manoscope/core/units.hpp"
#include "manoscope/maps/channel_map.hpp"

namespace manoscope::maps {

/// Noise of one pixel and how far it reaches.
struct PixelNoise {
  Length sigma{};         ///< standard deviation of one pixel (robust)
  double length_x = 1.0;  ///< neighbouring pixels along x that share one independent error
  double length_z = 1.0;  ///< the same along z
};

/// Measures the noise on the rim of a leveled map.
///
/// sigma is 1.4826 times the median absolute height. The lengths are 1 + 2 sum_k rho_k over the
/// lags at which the autocorrelation rho_k stands above twice its own noise, at most 50 lags;
/// heights beyond 5 sigma are left out.
/// @param rim  (nz, nx), 1 on the rim.
PixelNoise measure_noise(const ChannelMap& leveled, const Flags2& rim);

}  // namespace manoscope::maps
