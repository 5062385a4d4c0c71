#include "manoscope/twin/interferometer.hpp"

#include <array>
#include <cmath>
#include <string_view>
#include <utility>
#include <vector>

#include "manoscope/core/random.hpp"
#include "manoscope/twin/map_errors.hpp"
#include "manoscope/twin/point_spread.hpp"

namespace manoscope::twin {
namespace {

/// Position (x, z) of a point of the camera in the channel: camera_from_channel() undone.
std::array<double, 2> channel_from_camera(const ChannelFrame& frame, double column, double row) {
  const double dc = column - frame.origin_x.si(), dr = row - frame.origin_y.si();
  const double c = std::cos(frame.rotation.si()), s = std::sin(frame.rotation.si());
  const double u = c * dc + s * dr, v = -s * dc + c * dr;
  const double along = frame.along_columns() ? u : v, across = frame.along_columns() ? v : u;
  return {frame.flow_sign() * along, frame.across_sign() * across - 0.5 * frame.width.si()};
}

/// How the sample lies under the camera while one map is taken.
struct Posture {
  double column = 0.0, row = 0.0;       // m, lateral shift
  double turn = 0.0;                    // rad, about the map's centre
  double slope_x = 0.0, slope_y = 0.0;  // m/m
  double offset = 0.0;                  // m
};

/// Sum of the steps up to a map: a random walk that is 0 at map 0.
std::array<double, 2> walk(const MapKey& key, std::string_view name) {
  RandomStream steps(key.seed, name);
  std::array<double, 2> sum{};
  for (std::uint64_t i = 0; i < key.index; ++i) {
    for (double& component : sum) component += steps.normal();
  }
  return sum;
}

Posture draw_posture(const InterferometerOptions& options, const MapKey& key) {
  Posture posture;
  RandomStream placing(key.seed, "shift", key.index);
  posture.column = options.shift.si() * placing.normal();
  posture.row = options.shift.si() * placing.normal();
  RandomStream leaning(key.seed, "tilt", key.index);
  double tilt_x = options.tilt.si() * leaning.normal();
  double tilt_y = options.tilt.si() * leaning.normal();
  posture.offset = options.piston.si() * RandomStream(key.seed, "piston", key.index).normal();
  posture.turn =
      options.rotation_scatter.si() * RandomStream(key.seed, "rotation", key.index).normal();
  if (options.shift_drift > Length{}) {
    const auto [column, row] = walk(key, "shift drift");
    posture.column += options.shift_drift.si() * column;
    posture.row += options.shift_drift.si() * row;
  }
  if (options.tilt_drift > Angle{}) {
    const auto [x, y] = walk(key, "tilt drift");
    tilt_x += options.tilt_drift.si() * x;
    tilt_y += options.tilt_drift.si() * y;
  }
  if (options.piston_drift > Length{}) {
    posture.offset += options.piston_drift.si() * walk(key, "piston drift")[0];
  }
  posture.slope_x = std::tan(tilt_x);
  posture.slope_y = std::tan(tilt_y);
  return posture;
}

/// The frame of a channel that was turned about the map's centre, then shifted.
ChannelFrame moved(ChannelFrame frame, const CameraGrid& grid, const Posture& posture) {
  if (posture.turn != 0.0) {
    const double cx = 0.5 * grid.size_x().si(), cy = 0.5 * grid.size_y().si();
    const double dx = frame.origin_x.si() - cx, dy = frame.origin_y.si() - cy;
    const double c = std::cos(posture.turn), s = std::sin(posture.turn);
    frame.origin_x = Length::from_si(cx + c * dx - s * dy);
    frame.origin_y = Length::from_si(cy + s * dx + c * dy);
    frame.rotation += Angle::from_si(posture.turn);
  }
  frame.origin_x += Length::from_si(posture.column);
  frame.origin_y += Length::from_si(posture.row);
  return frame;
}

}  // namespace

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

HeightMap record_map(const flow::Channel& channel, const WallShape& shape,
                     const InterferometerOptions& options, std::uint64_t seed,
                     std::uint64_t map_index) {
  const CameraGrid grid = camera_grid(channel, options);
  const MapKey key{seed, map_index};
  const Posture posture = draw_posture(options, key);
  const ChannelFrame frame = moved(channel_frame(channel, options), grid, posture);

  const double sign = options.outward == Outward::plus_height ? 1.0 : -1.0;
  const auto centre = [](Index i, Length pitch) {
    return (static_cast<double>(i) + 0.5) * pitch.si();
  };
  Array2 height(grid.ny, grid.nx);
  for (Index iy = 0; iy < grid.ny; ++iy) {
    for (Index ix = 0; ix < grid.nx; ++ix) {
      const auto [x, z] =
          channel_from_camera(frame, centre(ix, grid.pitch_x), centre(iy, grid.pitch_y));
      height(iy, ix) = sign * shape(x, z);
    }
  }
  if (options.blur > Length{}) {
    blur(height, options.blur / grid.pitch_x, options.blur / grid.pitch_y);
  }
  for (Index iy = 0; iy < grid.ny; ++iy) {
    const double row = centre(iy, grid.pitch_y) - 0.5 * grid.size_y().si();
    for (Index ix = 0; ix < grid.nx; ++ix) {
      const double column = centre(ix, grid.pitch_x) - 0.5 * grid.size_x().si();
      height(iy, ix) =
          height(iy, ix) + posture.offset + posture.slope_x * column + posture.slope_y * row;
    }
  }
  add_height_errors(options, grid, key, height);
  return HeightMap(grid, std::move(height), lost_pixels(options, grid, key));
}

HeightMap record_map(const flow::Channel& channel, const ChannelCurve& deflection,
                     const InterferometerOptions& options, std::uint64_t seed,
                     std::uint64_t map_index) {
  return record_map(channel, parabolic_shape(channel.width, deflection), options, seed, map_index);
}

}  // namespace manoscope::twin
