#include "manoscope/twin/map_errors.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "manoscope/core/random.hpp"
#include "manoscope/twin/point_spread.hpp"

namespace manoscope::twin {
namespace {

/// Calls `visit(disc, iy, ix)` for the pixels of discs that cover a fraction of the map; overlaps
/// and the map's edge take some of it.
/// @param low, high  bounds of the radius, in pixels.
/// @param begin  called before each disc, to draw what is common to it.
template <class Begin, class Visit>
void scatter_discs(RandomStream& random, double fraction, double low, double high, Index n_rows,
                   Index n_cols, Begin&& begin, Visit&& visit) {
  const double area = std::numbers::pi * (low * low + low * high + high * high) / 3.0;
  const double expected = fraction * static_cast<double>(n_rows * n_cols) / area;
  const auto count = static_cast<Index>(expected + random.uniform());
  const auto bound = [](double value, Index n) {
    return std::clamp<Index>(static_cast<Index>(std::floor(value)), 0, n - 1);
  };
  for (Index i = 0; i < count; ++i) {
    const double cx = random.uniform(0.0, static_cast<double>(n_cols));
    const double cy = random.uniform(0.0, static_cast<double>(n_rows));
    const double radius = random.uniform(low, high);
    begin();
    for (Index iy = bound(cy - radius, n_rows); iy <= bound(cy + radius, n_rows); ++iy) {
      for (Index ix = bound(cx - radius, n_cols); ix <= bound(cx + radius, n_cols); ++ix) {
        const double dx = static_cast<double>(ix) + 0.5 - cx;
        const double dy = static_cast<double>(iy) + 0.5 - cy;
        if (dx * dx + dy * dy < radius * radius) visit(iy, ix);
      }
    }
  }
}

void add_curvature(const InterferometerOptions& options, const MapKey& key, Array2& height) {
  if (options.curvature == Length{}) return;
  RandomStream form(key.seed, "curvature");  // one for all maps
  const double xx = options.curvature.si() * form.normal();
  const double yy = options.curvature.si() * form.normal();
  const double xy = options.curvature.si() * form.normal();
  const auto place = [](Index i, Index n) {
    return (2.0 * static_cast<double>(i) + 1.0) / static_cast<double>(n) - 1.0;
  };
  for (Index iy = 0; iy < height.rows(); ++iy) {
    const double v = place(iy, height.rows());
    for (Index ix = 0; ix < height.cols(); ++ix) {
      const double u = place(ix, height.cols());
      height(iy, ix) += xx * u * u + yy * v * v + xy * u * v;
    }
  }
}

void add_noise(const InterferometerOptions& options, const CameraGrid& grid, const MapKey& key,
               Array2& height) {
  if (options.noise > Length{}) {
    RandomStream noise(key.seed, "pixel noise", key.index);
    for (Index i = 0; i < height.size(); ++i) {
      height.data()[i] += options.noise.si() * noise.normal();
    }
  }
  if (options.correlated_noise > Length{}) {
    RandomStream noise(key.seed, "correlated noise", key.index);
    height +=
        options.correlated_noise.si() *
        correlated_noise(height.rows(), height.cols(), options.correlation_length / grid.pitch_x,
                         options.correlation_length / grid.pitch_y, noise);
  }
}

void add_spikes(const InterferometerOptions& options, const MapKey& key, Array2& height) {
  RandomStream spikes(key.seed, "spikes", key.index);
  for (Index i = 0; i < height.size(); ++i) {
    if (spikes.uniform() >= options.spikes) continue;
    const double sign = spikes.uniform() < 0.5 ? -1.0 : 1.0;
    height.data()[i] += sign * spikes.uniform(0.5, 1.5) * options.spike_height.si();
  }
}

void add_fringe_jumps(const InterferometerOptions& options, const MapKey& key, Array2& height) {
  if (options.fringe_jumps == 0.0) return;
  constexpr double kLow = 3.0, kHigh = 10.0;  // radius in pixels
  RandomStream jumps(key.seed, "fringe jumps", key.index);
  Array2 order = Array2::Zero(height.rows(), height.cols());
  double sign = 1.0;
  scatter_discs(
      jumps, options.fringe_jumps, kLow, kHigh, height.rows(), height.cols(),
      [&] { sign = jumps.uniform() < 0.5 ? -1.0 : 1.0; },
      [&](Index iy, Index ix) { order(iy, ix) = sign; });  // where two meet, the later counts
  height += 0.5 * options.wavelength.si() * order;
}

}  // namespace

void add_height_errors(const InterferometerOptions& options, const CameraGrid& grid,
                       const MapKey& key, Array2& height) {
  add_curvature(options, key, height);
  add_noise(options, grid, key, height);
  add_spikes(options, key, height);
  add_fringe_jumps(options, key, height);
  if (options.quantisation > Length{}) {
    const double step = options.quantisation.si();
    height = step * (height / step).round();
  }
}

Flags2 lost_pixels(const InterferometerOptions& options, const CameraGrid& grid,
                   const MapKey& key) {
  constexpr double kLow = 1.5, kHigh = 3.5;  // radius in pixels
  Flags2 flags = Flags2::Zero(grid.ny, grid.nx);
  RandomStream single(key.seed, "dropouts", key.index);
  for (Index i = 0; i < flags.size(); ++i) {
    if (single.uniform() < options.dropouts) flags.data()[i] = PixelFlag::no_data;
  }
  RandomStream blobs(key.seed, "blobs", key.index);
  scatter_discs(
      blobs, options.blobs, kLow, kHigh, flags.rows(), flags.cols(), [] {},
      [&](Index iy, Index ix) { flags(iy, ix) = PixelFlag::no_data; });
  return flags;
}

}  // namespace manoscope::twin
