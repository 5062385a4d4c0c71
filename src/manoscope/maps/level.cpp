#include "manoscope/maps/level.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "manoscope/core/error.hpp"
#include "manoscope/numerics/grid_plane.hpp"

namespace manoscope::maps {

RimPlane fit_rim_plane(const ChannelMap& map, const Flags2& rim, const std::string& name) {
  constexpr Index kFewest = 100;  // a plane to a tenth of the pixel noise
  const ChannelGrid& grid = map.grid;
  const double x_centre = grid.x(grid.nx - 1) * 0.5 + grid.x(0) * 0.5;
  const double scale_x = std::max(0.5 * (grid.x(grid.nx - 1) - grid.x(0)), 1e-12);
  const double scale_z = std::max({std::abs(grid.z(0)), std::abs(grid.z(grid.nz - 1)), 1e-12});

  Array1 a(grid.nx), b(grid.nz);
  for (Index ix = 0; ix < grid.nx; ++ix) a[ix] = (grid.x(ix) - x_centre) / scale_x;
  for (Index iz = 0; iz < grid.nz; ++iz) b[iz] = grid.z(iz) / scale_z;
  const numerics::GridPoints points(a, b, map.height, rim, map.flags);
  const Index n = points.size();
  const auto fit = n >= kFewest ? numerics::fit_plane(points) : std::nullopt;
  if (!fit) {
    throw InputError(name,
                     fmt::format("{} good pixels lie on the rigid rim around the channel, which "
                                 "leaves its plane undetermined",
                                 n),
                     "Check channel.origin, length and width against the map, and image the wall "
                     "with some of its rigid frame on two sides or more");
  }
  RimPlane plane;
  plane.offset = fit->coefficient[0];
  plane.tilt_x = fit->coefficient[1] / scale_x;
  plane.tilt_z = fit->coefficient[2] / scale_z;
  plane.x_centre = x_centre;
  const Eigen::Vector3d unscale(1.0, 1.0 / scale_x, 1.0 / scale_z);
  plane.covariance = unscale.asDiagonal() * fit->covariance * unscale.asDiagonal();
  plane.sigma = Length::from_si(fit->sigma);
  plane.inlier_fraction = fit->inlier_fraction;
  plane.n_samples = n;
  return plane;
}

void subtract_plane(ChannelMap& map, const RimPlane& plane) {
  Array1 on_centre_line(map.grid.nx);
  for (Index ix = 0; ix < map.grid.nx; ++ix) on_centre_line[ix] = plane.height(map.grid.x(ix), 0.0);
  for (Index iz = 0; iz < map.grid.nz; ++iz) {
    map.height.row(iz) -= on_centre_line.transpose() + plane.tilt_z * map.grid.z(iz);
  }
}

}  // namespace manoscope::maps
