#pragma once

#include "manoscope/core/arrays.hpp"
#include "manoscope/core/frame.hpp"
#include "manoscope/core/grid.hpp"
#include "manoscope/core/height_map.hpp"
#include "manoscope/maps/centre_line.hpp"

namespace manoscope::maps {

/// Heights in the channel's frame, outward positive, before any leveling.
///
/// Arrays have shape (nz, nx), row-major: a row runs along the flow. Unit: m. A sample counts only
/// where `flags` is 0 (bits of PixelFlag).
struct ChannelMap {
  ChannelGrid grid;
  Array2 height;
  Flags2 flags;
};

/// Grid of the camera's pixels seen along the channel's axes, the rotation left out.
ChannelGrid channel_grid(const CameraGrid& camera, const ChannelFrame& frame);

/// Turns a camera map into the channel's frame.
///
/// Without rotation pixels are moved, not interpolated. With rotation each sample is the bilinear
/// mean of the four pixels around it, on a grid of the camera's pitch, and counts only if all four
/// do; neighbouring samples then share noise. Samples beyond the map are no_data.
ChannelMap to_channel_frame(const HeightMap& map, const ChannelFrame& frame);

/// Samples on the rigid rim: farther than `margin` outside the channel's rectangle.
/// @param centre  where the rectangle's middle runs in this map.
/// @return (nz, nx), 1 on the rim.
Flags2 rim_mask(const ChannelGrid& grid, Length channel_length, Length channel_width, Length margin,
                const CentreLine& centre = {});

}  // namespace manoscope::maps
