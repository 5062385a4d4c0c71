#include "manoscope/maps/channel_map.hpp"

#include <algorithm>
#include <cmath>

#include "manoscope/core/flags.hpp"

namespace manoscope::maps {
namespace {

/// Moves pixels only: transposes and reverses.
template <class Array>
Array reorder(const Array& camera, const ChannelFrame& frame) {
  const bool reverse_x = frame.flow_sign() < 0.0, reverse_z = frame.across_sign() < 0.0;
  if (frame.along_columns() && !reverse_x && !reverse_z) return camera;
  const Index nx = frame.along_columns() ? camera.cols() : camera.rows();
  const Index nz = frame.along_columns() ? camera.rows() : camera.cols();
  Array result(nz, nx);
  for (Index iz = 0; iz < nz; ++iz) {
    const Index across = reverse_z ? nz - 1 - iz : iz;
    for (Index ix = 0; ix < nx; ++ix) {
      const Index along = reverse_x ? nx - 1 - ix : ix;
      result(iz, ix) = frame.along_columns() ? camera(across, along) : camera(along, across);
    }
  }
  return result;
}

ChannelMap rotated(const HeightMap& map, const ChannelFrame& frame) {
  const CameraGrid& camera = map.grid();
  ChannelMap result;
  result.grid = channel_grid(camera, frame);
  const ChannelGrid& grid = result.grid;
  result.height = Array2::Zero(grid.nz, grid.nx);
  result.flags = Flags2::Constant(grid.nz, grid.nx, PixelFlag::no_data);
  for (Index iz = 0; iz < grid.nz; ++iz) {
    for (Index ix = 0; ix < grid.nx; ++ix) {
      const auto [column, row] = frame.camera_from_channel(grid.x(ix), grid.z(iz));
      const double a = column / camera.pitch_x.si() - 0.5, b = row / camera.pitch_y.si() - 0.5;
      // Half a pixel beyond the outer centres is still inside the map: use the nearest pixels.
      if (a < -0.5 || b < -0.5 || a > static_cast<double>(camera.nx) - 0.5 ||
          b > static_cast<double>(camera.ny) - 0.5) {
        continue;
      }
      const Index i = std::clamp<Index>(static_cast<Index>(std::floor(a)), 0, camera.nx - 2);
      const Index j = std::clamp<Index>(static_cast<Index>(std::floor(b)), 0, camera.ny - 2);
      const double s = a - static_cast<double>(i), t = b - static_cast<double>(j);
      const auto& h = map.height();
      const auto& f = map.flags();
      result.height(iz, ix) = (1 - t) * ((1 - s) * h(j, i) + s * h(j, i + 1)) +
                              t * ((1 - s) * h(j + 1, i) + s * h(j + 1, i + 1));
      result.flags(iz, ix) =
          static_cast<FlagBits>(f(j, i) | f(j, i + 1) | f(j + 1, i) | f(j + 1, i + 1));
    }
  }
  return result;
}

}  // namespace

ChannelGrid channel_grid(const CameraGrid& camera, const ChannelFrame& frame) {
  const bool along_columns = frame.along_columns();
  const Length pitch_x = along_columns ? camera.pitch_x : camera.pitch_y;
  const Length pitch_z = along_columns ? camera.pitch_y : camera.pitch_x;
  const Length size_x = along_columns ? camera.size_x() : camera.size_y();
  const Length size_z = along_columns ? camera.size_y() : camera.size_x();
  const Length origin_x = along_columns ? frame.origin_x : frame.origin_y;
  const Length origin_z = along_columns ? frame.origin_y : frame.origin_x;
  ChannelGrid grid;
  grid.nx = along_columns ? camera.nx : camera.ny;
  grid.nz = along_columns ? camera.ny : camera.nx;
  grid.pitch_x = pitch_x;
  grid.pitch_z = pitch_z;
  // The first sample is the pixel at the lowest x (z): the map's far end if the axis is reversed.
  grid.x0 = (frame.flow_sign() > 0.0 ? -origin_x : origin_x - size_x) + 0.5 * pitch_x;
  grid.z0 = (frame.across_sign() > 0.0 ? -origin_z : origin_z - size_z) + 0.5 * pitch_z -
            0.5 * frame.width;
  return grid;
}

ChannelMap to_channel_frame(const HeightMap& map, const ChannelFrame& frame) {
  ChannelMap result;
  if (frame.rotation != Angle{} && map.grid().nx >= 2 && map.grid().ny >= 2) {
    result = rotated(map, frame);
  } else {
    result.grid = channel_grid(map.grid(), frame);
    result.height = reorder(map.height(), frame);
    result.flags = reorder(map.flags(), frame);
  }
  if (frame.outward == Outward::minus_height) result.height = -result.height;
  return result;
}

Flags2 rim_mask(const ChannelGrid& grid, Length channel_length, Length channel_width, Length margin,
                const CentreLine& centre) {
  const double left = -margin.si(), right = channel_length.si() + margin.si();
  const double half = 0.5 * channel_width.si() + margin.si();
  Flags2 mask = Flags2::Ones(grid.nz, grid.nx);
  Index first = 0, end = grid.nx;  // columns that the channel crosses
  while (first < end && !(grid.x(first) > left)) ++first;
  while (end > first && !(grid.x(end - 1) < right)) --end;
  if (first == end) return mask;
  Array1 middle(grid.nx);
  for (Index ix = first; ix < end; ++ix) middle[ix] = centre.z(grid.x(ix), channel_length.si());
  const auto columns = middle.segment(first, end - first);
  const double lowest = columns.minCoeff(), highest = columns.maxCoeff();
  for (Index iz = 0; iz < grid.nz; ++iz) {
    const double z = grid.z(iz);
    if (z - highest >= half || lowest - z >= half) continue;
    FlagBits* const row = &mask(iz, 0);
    if (std::abs(z - lowest) < half && std::abs(z - highest) < half) {
      std::fill(row + first, row + end, FlagBits{0});
      continue;
    }
    for (Index ix = first; ix < end; ++ix) {
      if (std::abs(z - middle[ix]) < half) row[ix] = 0;
    }
  }
  return mask;
}

}  // namespace manoscope::maps
