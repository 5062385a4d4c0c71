#pragma once

#include "manoscope/core/index.hpp"
#include "manoscope/core/units.hpp"

namespace manoscope {

/// Pixels of an instrument map: column ix counts along x, row iy along y, as stored in the file.
///
/// The centre of pixel (iy, ix) lies at ((ix + 1/2) pitch_x, (iy + 1/2) pitch_y) from the outer
/// corner of the first pixel; the map covers nx pitch_x by ny pitch_y.
struct CameraGrid {
  Index nx = 0, ny = 0;
  Length pitch_x{}, pitch_y{};

  Length size_x() const { return static_cast<double>(nx) * pitch_x; }
  Length size_y() const { return static_cast<double>(ny) * pitch_y; }
  friend bool operator==(const CameraGrid&, const CameraGrid&) = default;
};

/// Samples of the wall in the channel's own frame: x along the flow from the inlet edge, z across
/// from the centre line.
///
/// Sample (iz, ix) lies at (x0 + ix pitch_x, z0 + iz pitch_z). The grid reaches beyond the channel
/// (x < 0, x > l, |z| > w/2) over the rigid rim.
struct ChannelGrid {
  Index nx = 0, nz = 0;
  Length pitch_x{}, pitch_z{};
  Length x0{}, z0{};

  double x(Index ix) const { return x0.si() + static_cast<double>(ix) * pitch_x.si(); }
  double z(Index iz) const { return z0.si() + static_cast<double>(iz) * pitch_z.si(); }
  friend bool operator==(const ChannelGrid&, const ChannelGrid&) = default;
};

}  // namespace manoscope
