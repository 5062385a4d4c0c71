#pragma once

#include <vector>

#include "manoscope/core/arrays.hpp"
#include "manoscope/maps/channel_map.hpp"

namespace manoscope::maps {

/// A border between two neighbouring pixels across which the height jumps.
struct FringeJump {
  Index from, to;  ///< pixels, row-major; `to` is the right or the lower one
  double size;     ///< m, height of `to` over that of `from`, the slope around left out
};

/// Jumps between good neighbours along x and z, row by row.
///
/// A step between two pixels is a jump if it lies farther than `least` outside the range of the
/// steps before and behind it on the same line, and exceeds twice their own changes: so neither
/// slopes nor bends nor the kink at a clamped edge count.
///
/// @param least  m.
/// @param noise  m, standard deviation of one pixel.
/// @param cuts   (nz, nx): gets a bit for each pixel that a jump parts from the right (1) or the
///               lower neighbour (2).
std::vector<FringeJump> find_fringe_jumps(const ChannelMap& map, double least, double noise,
                                          Flags2& cuts);

}  // namespace manoscope::maps
