#pragma once

#include <string>

#include "manoscope/core/arrays.hpp"
#include "manoscope/core/frame.hpp"
#include "manoscope/core/height_map.hpp"

namespace manoscope::maps {

/// What the wall did between two pressures, as a picture in the channel's frame: for eyes that
/// check whether the channel's rectangle lies on the part that moves.
struct ResponsePicture {
  Array1 x, z;    ///< m, centres of the cells; z from the centre line
  Array2 height;  ///< (n_z, n_x) m, outward positive, means over cells; NaN where no pixel counts
};

/// after - before in the channel's frame, leveled on the rim around the channel, in at most
/// 256 x 96 cells of whole pixels.
/// @throws InputError if the grids differ or no rim is in the map.
ResponsePicture picture_response(const HeightMap& before, const HeightMap& after,
                                 const ChannelFrame& frame, const std::string& name);

}  // namespace manoscope::maps
