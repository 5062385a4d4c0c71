// Synthetic height maps with known truth, in any orientation, for tests.
#pragma once

#include <cmath>
#include <limits>

#include "manoscope/core/arrays.hpp"
#include "manoscope/core/frame.hpp"
#include "manoscope/core/grid.hpp"
#include "manoscope/core/height_map.hpp"
#include "manoscope/core/random.hpp"

namespace manoscope::test_support {

struct ChannelPoint {
  double x, z;  ///< m
};

/// Channel point under a camera position, written independently of ChannelFrame's own formula:
/// turn back by the rotation, then read off the distances along and across the flow.
inline ChannelPoint channel_from_camera(const ChannelFrame& frame, double column, double row) {
  const double dx = column - frame.origin_x.si(), dy = row - frame.origin_y.si();
  const double c = std::cos(frame.rotation.si()), s = std::sin(frame.rotation.si());
  const double u = c * dx + s * dy, v = -s * dx + c * dy;  // along columns, along rows
  double x = 0.0, across = 0.0;
  switch (frame.flow) {
    case FlowDirection::plus_columns:
      x = u, across = v;
      break;
    case FlowDirection::minus_columns:
      x = -u, across = v;
      break;
    case FlowDirection::plus_rows:
      x = v, across = u;
      break;
    case FlowDirection::minus_rows:
      x = -v, across = u;
      break;
  }
  if (frame.across_reversed) across = -across;
  return {x, across - 0.5 * frame.width.si()};
}

/// Membrane clamped on a rectangle: parabola across the width, tapered at the ends over `taper`,
/// falling linearly by the share `fall` along the flow. Its width average is exact.
struct Bulge {
  double length = 15.5e-3, width = 1.7e-3;  ///< m
  double crest = 20e-6;                     ///< m
  double taper = 0.54e-3;                   ///< m
  double fall = 0.0;

  double along(double x) const {
    if (x < 0.0 || x > length) return 0.0;
    const double taper_in = 1.0 - std::exp(-x / taper);
    const double taper_out = 1.0 - std::exp(-(length - x) / taper);
    return crest * taper_in * taper_out * (1.0 - fall * x / length);
  }
  double operator()(double x, double z) const {
    const double u = 2.0 * z / width;
    return std::abs(u) < 1.0 ? along(x) * (1.0 - u * u) : 0.0;
  }
  double width_average(double x) const { return along(x) * 2.0 / 3.0; }
};

/// What an interferometer adds to the wall.
struct MapErrors {
  double noise = 0.0;                            ///< m, white
  double tilt_columns = 0.0;                     ///< m/m
  double tilt_rows = 0.0;                        ///< m/m
  double piston = 0.0;                           ///< m
  double dropouts = 0.0;                         ///< share of single pixels without data
  int blobs = 0;                                 ///< round patches without data ...
  double blob_radius = 0.0;                      ///< m
  double spikes = 0.0;                           ///< share of pixels off by spike_size, either way
  double spike_size = 0.0;                       ///< m
  double shift_columns = 0.0, shift_rows = 0.0;  ///< m, of the wall against the frame
};

/// The map an instrument gives of the wall zeta(x, z) seen through `frame`.
template <class Wall>
HeightMap synthetic_map(const CameraGrid& grid, const ChannelFrame& frame, const Wall& zeta,
                        const MapErrors& errors, RandomStream& stream) {
  const double sign = frame.outward == Outward::plus_height ? 1.0 : -1.0;
  Array2 height(grid.ny, grid.nx);
  for (Index iy = 0; iy < grid.ny; ++iy) {
    const double row = (static_cast<double>(iy) + 0.5) * grid.pitch_y.si();
    for (Index ix = 0; ix < grid.nx; ++ix) {
      const double column = (static_cast<double>(ix) + 0.5) * grid.pitch_x.si();
      const ChannelPoint at =
          channel_from_camera(frame, column - errors.shift_columns, row - errors.shift_rows);
      double value = sign * zeta(at.x, at.z) + errors.piston + errors.tilt_columns * column +
                     errors.tilt_rows * row;
      if (errors.noise > 0.0) value += errors.noise * stream.normal();
      if (errors.spikes > 0.0 && stream.uniform() < errors.spikes) {
        value += stream.uniform() < 0.5 ? errors.spike_size : -errors.spike_size;
      }
      if (errors.dropouts > 0.0 && stream.uniform() < errors.dropouts) {
        value = std::numeric_limits<double>::quiet_NaN();
      }
      height(iy, ix) = value;
    }
  }
  for (int blob = 0; blob < errors.blobs; ++blob) {
    const double column = stream.uniform(0.0, grid.size_x().si());
    const double row = stream.uniform(0.0, grid.size_y().si());
    for (Index iy = 0; iy < grid.ny; ++iy) {
      for (Index ix = 0; ix < grid.nx; ++ix) {
        const double dx = (static_cast<double>(ix) + 0.5) * grid.pitch_x.si() - column;
        const double dy = (static_cast<double>(iy) + 0.5) * grid.pitch_y.si() - row;
        if (dx * dx + dy * dy < errors.blob_radius * errors.blob_radius) {
          height(iy, ix) = std::numeric_limits<double>::quiet_NaN();
        }
      }
    }
  }
  return HeightMap(grid, std::move(height));
}

/// A frame whose rectangle's low corner in the camera (lowest column, lowest row, before rotation)
/// is (column, row), whatever the flow direction and side.
inline ChannelFrame frame_at(Length length, Length width, FlowDirection flow, bool across_reversed,
                             Length column, Length row) {
  ChannelFrame frame;
  frame.length = length;
  frame.width = width;
  frame.flow = flow;
  frame.across_reversed = across_reversed;
  const Length along = frame.flow_sign() > 0.0 ? Length{} : length;
  const Length across = across_reversed ? width : Length{};
  frame.origin_x = column + (frame.along_columns() ? along : across);
  frame.origin_y = row + (frame.along_columns() ? across : along);
  return frame;
}

/// Mean and width of standardised errors.
struct Pulls {
  double n = 0.0, sum = 0.0, squares = 0.0;

  void add(double pull) {
    n += 1.0;
    sum += pull;
    squares += pull * pull;
  }
  double mean() const { return sum / n; }
  double width() const { return std::sqrt(squares / n); }  ///< about 0: a bias counts too
};

}  // namespace manoscope::test_support
