#include "manoscope/maps/camera_window.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "manoscope/core/error.hpp"
#include "manoscope/core/flags.hpp"

namespace manoscope::maps {

HeightMap into_window(const HeightMap& map, Index offset_x, Index offset_y,
                      const CameraWindow& window, const std::string& name) {
  const CameraGrid &from = map.grid(), &to = window.grid;
  if (from.pitch_x != to.pitch_x || from.pitch_y != to.pitch_y) {
    throw InputError(
        name,
        fmt::format("has pixels of {:.8g} x {:.8g} um, the first map {:.8g} x {:.8g}",
                    from.pitch_x.in(um), from.pitch_y.in(um), to.pitch_x.in(um), to.pitch_y.in(um)),
        "Take all maps of one experiment with the same camera settings");
  }
  // Pixel (iy, ix) of the map is pixel (iy + down, ix + right) of the window.
  const Index right = offset_x - window.offset_x, down = offset_y - window.offset_y;
  const Index x0 = std::max<Index>(0, right), x1 = std::min(to.nx, from.nx + right);
  const Index y0 = std::max<Index>(0, down), y1 = std::min(to.ny, from.ny + down);
  if (x0 >= x1 || y0 >= y1) {
    throw InputError(
        name,
        fmt::format("shows {} x {} pixels of the camera from ({}, {}), the first map {} x {} from "
                    "({}, {}): they have none in common",
                    from.nx, from.ny, offset_x, offset_y, to.nx, to.ny, window.offset_x,
                    window.offset_y),
        "Take all maps of one experiment through the same window of the camera");
  }
  Array2 height = Array2::Zero(to.ny, to.nx);
  Flags2 flags = Flags2::Constant(to.ny, to.nx, PixelFlag::no_data);
  height.block(y0, x0, y1 - y0, x1 - x0) =
      map.height().block(y0 - down, x0 - right, y1 - y0, x1 - x0);
  flags.block(y0, x0, y1 - y0, x1 - x0) =
      map.flags().block(y0 - down, x0 - right, y1 - y0, x1 - x0);
  return {to, std::move(height), std::move(flags)};
}

}  // namespace manoscope::maps
