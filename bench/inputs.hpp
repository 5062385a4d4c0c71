// What the benchmarks measure: one camera, one wall.
#pragma once

#include <numbers>

#include "manoscope/twin/scenario.hpp"

namespace manoscope::bench {

inline constexpr std::uint64_t kSeed = 7;

/// A camera of 1024 x 192 pixels over the channel of small_s1(), with 20 nm of noise, 1 % of
/// dropouts and 0.2 % of spikes.
inline twin::InterferometerOptions full_camera() {
  twin::InterferometerOptions camera = twin::small_s1().camera;
  camera.n_along = 1024;
  camera.n_across = 192;
  camera.noise = 20.0 * nm;
  camera.dropouts = 0.01;
  camera.spikes = 0.002;
  return camera;
}

/// Deflection of map `index` of `n`: a clamped bulge falling along the flow, between -10 and 40 um.
inline twin::ChannelCurve bulge(const flow::Channel& channel, int index, int n) {
  constexpr Index kNodes = 401;
  const double high = -10e-6 + 50e-6 * index / std::max(1, n - 1);
  const double length = channel.length.si(), reach = channel.width.si() / std::numbers::pi;
  const Array1 x = Array1::LinSpaced(kNodes, 0.0, length);
  const Array1 ends = (1.0 - (-x / reach).exp()) * (1.0 - ((x - length) / reach).exp());
  return {channel.length, high * (1.0 - 0.5 * x / length) * ends};
}

}  // namespace manoscope::bench
