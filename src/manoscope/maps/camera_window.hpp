#pragma once

#include <string>

#include "manoscope/core/height_map.hpp"

namespace manoscope::maps {

/// The pixels of a camera that a map shows: instruments read out a window and name its first pixel.
struct CameraWindow {
  CameraGrid grid;
  Index offset_x = 0, offset_y = 0;  ///< column and row of its first pixel in the camera
};

/// The map as the camera would have shown it through another window: pixel for pixel, no_data where
/// its own window does not reach; what lies beyond the other one is left out.
///
/// @param offset_x, offset_y  first pixel of the map's own window.
/// @param name  of the map, for messages.
/// @throws InputError if the pitches differ, or the two windows have no pixel in common.
HeightMap into_window(const HeightMap& map, Index offset_x, Index offset_y,
                      const CameraWindow& window, const std::string& name);

}  // namespace manoscope::maps
