#include "manoscope/twin/interferometer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "manoscope/core/error.hpp"
#include "manoscope/core/flags.hpp"
#include "manoscope/core/random.hpp"

namespace manoscope::twin {
namespace {

constexpr int kMostPixels = 20000;  // along one axis

void require(bool holds, const std::string& found, const char* mend) {
  if (!holds) throw InputError("interferometer", found, mend);
}

void require_size(int n, const char* name) {
  require(n >= 8 && n <= kMostPixels, fmt::format("{} is {}", name, n), "Choose 8 to 20000 pixels");
}

template <class Q>
void require_not_negative(Q value, const char* name, const char* unit) {
  require(value.si() >= 0.0 && std::isfinite(value.si()),
          fmt::format("{} is {:g} {}", name, value.si(), unit), "Give 0 (off) or more");
}

void require_fraction(double value, const char* name) {
  require(value >= 0.0 && value <= 0.5, fmt::format("{} is {:g}", name, value),
          "Choose a fraction of the pixels in [0, 0.5]");
}

/// Position (x, z) of a point of the camera in the channel: camera_from_channel() undone.
std::array<double, 2> channel_from_camera(const ChannelFrame& frame, double column, double row) {
  const double dc = column - frame.origin_x.si(), dr = row - frame.origin_y.si();
  const double c = std::cos(frame.rotation.si()), s = std::sin(frame.rotation.si());
  const double u = c * dc + s * dr, v = -s * dc + c * dr;
  const double along = frame.along_columns() ? u : v, across = frame.along_columns() ? v : u;
  return {frame.flow_sign() * along, frame.across_sign() * across - 0.5 * frame.width.si()};
}

/// Loses pixels one by one and in blobs.
void drop_pixels(const InterferometerOptions& options, std::uint64_t seed, std::uint64_t map_index,
                 Flags2& flags) {
  RandomStream single(seed, "dropouts", map_index);
  for (Index i = 0; i < flags.size(); ++i) {
    if (single.uniform() < options.dropouts) flags.data()[i] = PixelFlag::no_data;
  }
  RandomStream blob(seed, "blobs", map_index);
  const double low = 1.5,
               high = 3.5;  // radius in pixels; mean area pi (low^2 + low high + high^2)/3
  const double area = std::numbers::pi * (low * low + low * high + high * high) / 3.0;
  const double expected = options.blobs * static_cast<double>(flags.size()) / area;
  const auto count = static_cast<Index>(expected + blob.uniform());
  for (Index i = 0; i < count; ++i) {
    const double cx = blob.uniform(0.0, static_cast<double>(flags.cols()));
    const double cy = blob.uniform(0.0, static_cast<double>(flags.rows()));
    const double radius = blob.uniform(low, high);
    const auto bound = [](double value, Index n) {
      return std::clamp<Index>(static_cast<Index>(std::floor(value)), 0, n - 1);
    };
    for (Index iy = bound(cy - radius, flags.rows()); iy <= bound(cy + radius, flags.rows());
         ++iy) {
      for (Index ix = bound(cx - radius, flags.cols()); ix <= bound(cx + radius, flags.cols());
           ++ix) {
        const double dx = static_cast<double>(ix) + 0.5 - cx;
        const double dy = static_cast<double>(iy) + 0.5 - cy;
        if (dx * dx + dy * dy < radius * radius) flags(iy, ix) = PixelFlag::no_data;
      }
    }
  }
}

void add_noise_and_spikes(const InterferometerOptions& options, std::uint64_t seed,
                          std::uint64_t map_index, Array2& height) {
  if (options.noise > Length{}) {
    RandomStream noise(seed, "pixel noise", map_index);
    for (Index i = 0; i < height.size(); ++i)
      height.data()[i] += options.noise.si() * noise.normal();
  }
  RandomStream spikes(seed, "spikes", map_index);
  for (Index i = 0; i < height.size(); ++i) {
    if (spikes.uniform() >= options.spikes) continue;
    const double sign = spikes.uniform() < 0.5 ? -1.0 : 1.0;
    height.data()[i] += sign * spikes.uniform(0.5, 1.5) * options.spike_height.si();
  }
}

}  // namespace

void InterferometerOptions::validate() const {
  require_size(n_along, "n_along");
  require_size(n_across, "n_across");
  require_not_negative(rim, "rim", "m");
  require_not_negative(noise, "noise", "m");
  require_not_negative(tilt, "tilt", "rad");
  require(tilt.si() < 0.1, fmt::format("tilt is {:g} rad", tilt.si()), "Choose less than 0.1 rad");
  require_not_negative(piston, "piston", "m");
  require_not_negative(shift, "shift", "m");
  require_fraction(dropouts, "dropouts");
  require_fraction(blobs, "blobs");
  require_fraction(spikes, "spikes");
  require_not_negative(spike_height, "spike_height", "m");
  require(std::abs(rotation.si()) < 0.2, fmt::format("rotation is {:g} rad", rotation.si()),
          "Choose a small angle, less than 0.2 rad");
}

CameraGrid camera_grid(const flow::Channel& channel, const InterferometerOptions& options) {
  options.validate();
  channel.validate("interferometer");
  const Length pitch_along =
      (channel.length + 2.0 * options.rim) / static_cast<double>(options.n_along);
  const Length pitch_across =
      (channel.width + 2.0 * options.rim) / static_cast<double>(options.n_across);
  if (channel_frame(channel, options).along_columns()) {
    return {options.n_along, options.n_across, pitch_along, pitch_across};
  }
  return {options.n_across, options.n_along, pitch_across, pitch_along};
}

ChannelFrame channel_frame(const flow::Channel& channel, const InterferometerOptions& options) {
  ChannelFrame frame;
  frame.length = channel.length;
  frame.width = channel.width;
  frame.flow = options.flow;
  frame.across_reversed = options.across_reversed;
  frame.rotation = options.rotation;
  frame.outward = options.outward;
  const Length along = frame.flow_sign() > 0.0 ? options.rim : channel.length + options.rim;
  const Length across = options.across_reversed ? channel.width + options.rim : options.rim;
  frame.origin_x = frame.along_columns() ? along : across;
  frame.origin_y = frame.along_columns() ? across : along;
  return frame;
}

Array1 pixel_stations(const flow::Channel& channel, const InterferometerOptions& options) {
  const double pitch =
      (channel.length + 2.0 * options.rim).si() / static_cast<double>(options.n_along);
  std::vector<double> inside;
  for (int i = 0; i < options.n_along; ++i) {
    const double x = (i + 0.5) * pitch - options.rim.si();
    if (x > 0.0 && x < channel.length.si()) inside.push_back(x);
  }
  return Eigen::Map<const Array1>(inside.data(), static_cast<Index>(inside.size()));
}

HeightMap record_map(const flow::Channel& channel, const UniformCurve& deflection,
                     const InterferometerOptions& options, std::uint64_t seed,
                     std::uint64_t map_index) {
  const CameraGrid grid = camera_grid(channel, options);
  ChannelFrame frame = channel_frame(channel, options);
  RandomStream placing(seed, "shift", map_index);
  frame.origin_x += placing.normal() * options.shift;
  frame.origin_y += placing.normal() * options.shift;
  RandomStream posture(seed, "tilt", map_index);
  const double slope_x = std::tan(options.tilt.si() * posture.normal());
  const double slope_y = std::tan(options.tilt.si() * posture.normal());
  const double offset = options.piston.si() * RandomStream(seed, "piston", map_index).normal();

  const double sign = options.outward == Outward::plus_height ? 1.0 : -1.0;
  const double half_width = 0.5 * channel.width.si();
  Array2 height(grid.ny, grid.nx);
  for (Index iy = 0; iy < grid.ny; ++iy) {
    const double row = (static_cast<double>(iy) + 0.5) * grid.pitch_y.si();
    for (Index ix = 0; ix < grid.nx; ++ix) {
      const double column = (static_cast<double>(ix) + 0.5) * grid.pitch_x.si();
      const auto [x, z] = channel_from_camera(frame, column, row);
      const double across = z / half_width;
      const double zeta =
          std::abs(across) < 1.0 ? 1.5 * deflection(x) * (1.0 - across * across) : 0.0;
      height(iy, ix) = sign * zeta + offset + slope_x * (column - 0.5 * grid.size_x().si()) +
                       slope_y * (row - 0.5 * grid.size_y().si());
    }
  }
  add_noise_and_spikes(options, seed, map_index, height);
  Flags2 flags = Flags2::Zero(grid.ny, grid.nx);
  drop_pixels(options, seed, map_index, flags);
  return HeightMap(grid, std::move(height), std::move(flags));
}

}  // namespace manoscope::twin
