#pragma once

#include <Eigen/Core>
#include <string>

#include "manoscope/core/units.hpp"
#include "manoscope/maps/channel_map.hpp"

namespace manoscope::maps {

/// The plane of the rigid rim of one map: offset + tilt_x (x - x_centre) + tilt_z z.
struct RimPlane {
  double offset = 0.0;    ///< m, at (x_centre, z = 0)
  double tilt_x = 0.0;    ///< m/m
  double tilt_z = 0.0;    ///< m/m
  double x_centre = 0.0;  ///< m
  /// Covariance of (offset, tilt_x, tilt_z) for white pixel noise of size `sigma`.
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  Length sigma{};                ///< robust standard deviation of the rim about the plane
  double inlier_fraction = 0.0;  ///< share of rim pixels within 4.685 sigma
  Index n_samples = 0;           ///< good rim pixels

  double height(double x, double z) const { return offset + tilt_x * (x - x_centre) + tilt_z * z; }
};

/// Fits the rim's plane robustly (Tukey's biweight), so that dust and spikes do not tilt it.
///
/// zeta counts from this plane: it is the plane of the undeflected wall as far as the frame that
/// holds the wall is rigid.
/// @param rim   (nz, nx), 1 on the rim; see rim_mask().
/// @param name  of the map, for messages.
/// @throws InputError if fewer than 100 good pixels lie on the rim or all of them on one line.
RimPlane fit_rim_plane(const ChannelMap& map, const Flags2& rim, const std::string& name);

/// Subtracts the plane from every sample.
void subtract_plane(ChannelMap& map, const RimPlane& plane);

}  // namespace manoscope::maps
