#pragma once

#include <Eigen/Core>

#include "manoscope/core/units.hpp"
#include "manoscope/maps/channel_map.hpp"

namespace manoscope::maps {

/// What the rim shows beyond its plane: a surface of second order fitted to its residuals.
///
/// height = c . (1, u, v, u^2, u v, v^2) with u = (x - x_centre) / reach_x, v = z / reach_z.
struct RimBend {
  using Terms = Eigen::Matrix<double, 6, 1>;

  Terms coefficient = Terms::Zero();  ///< m
  /// Of the coefficients, m^2, for white pixel noise of the size found on the rim.
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
  double x_centre = 0.0, reach_x = 1.0, reach_z = 1.0;  ///< m
  Length sigma{};  ///< standard deviation of the rim about the surface
  /// At mid-channel on the centre line: what a plane alone leaves in the deflection there, and its
  /// standard uncertainty for white noise.
  Length at_middle{}, at_middle_uncertainty{};

  double u(double x) const { return (x - x_centre) / reach_x; }
  double v(double z) const { return z / reach_z; }
  Terms terms(double x, double z) const {
    return (Terms() << 1.0, u(x), v(z), u(x) * u(x), u(x) * v(z), v(z) * v(z)).finished();
  }
  double height(double x, double z) const { return coefficient.dot(terms(x, z)); }
};

/// Fits it to the good rim pixels of a map leveled by its plane, of 40 000 and more to a part
/// evenly chosen, 20 000 at least, with the weights of Tukey's biweight about the plane and then
/// twice about the surface.
///
/// Zero where the rim's pixels do not determine it, as with a rim on two opposite sides only.
/// @param rim    (nz, nx), 1 on the rim.
/// @param sigma  standard deviation of the rim about its plane.
RimBend fit_rim_bend(const ChannelMap& leveled, const Flags2& rim, Length sigma,
                     Length channel_length);

/// Subtracts the surface from every sample.
void subtract_bend(ChannelMap& map, const RimBend& bend);

}  // namespace manoscope::maps
