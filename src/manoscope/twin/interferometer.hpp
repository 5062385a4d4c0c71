#pragma once

#include <cstdint>

#include "manoscope/core/frame.hpp"
#include "manoscope/core/height_map.hpp"
#include "manoscope/flow/channel.hpp"
#include "manoscope/twin/interferometer_options.hpp"
#include "manoscope/twin/wall_model.hpp"

namespace manoscope::twin {

/// Pixels of the camera: the channel and its rim exactly fill the map.
CameraGrid camera_grid(const flow::Channel& channel, const InterferometerOptions& options);

/// Where the channel lies in an unshifted map (before shift, with rotation about the corner).
ChannelFrame channel_frame(const flow::Channel& channel, const InterferometerOptions& options);

/// x of the pixel centres inside the channel of an unshifted, unrotated map: (n), m, ascending.
Array1 pixel_stations(const flow::Channel& channel, const InterferometerOptions& options);

/// The map a camera takes of a wall, each pixel at its centre, seen with the errors of `options`,
/// in this order: place of the sample (shift, rotation and their scatter), blur of the wall's
/// shape, tilt and piston, then those of add_height_errors() and lost_pixels().
///
/// Blur acts on heights: the fringes themselves are not modelled.
///
/// @param shape  zeta(x, z), m; it is 0 on the rim.
/// @param map_index  number of the map: each has its own errors. The same (seed, map_index) gives
///                   the same map.
/// @throws InputError if an option is out of range.
HeightMap record_map(const flow::Channel& channel, const WallShape& shape,
                     const InterferometerOptions& options, std::uint64_t seed,
                     std::uint64_t map_index);

/// The same of a wall with a parabolic section (parabolic_shape()).
///
/// @param deflection  width-averaged zeta(x), m, over the channel's length.
HeightMap record_map(const flow::Channel& channel, const ChannelCurve& deflection,
                     const InterferometerOptions& options, std::uint64_t seed,
                     std::uint64_t map_index);

}  // namespace manoscope::twin
