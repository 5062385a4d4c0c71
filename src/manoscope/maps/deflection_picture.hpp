#pragma once

#include "manoscope/core/deflection_map.hpp"
#include "manoscope/core/map_picture.hpp"

namespace manoscope::maps {

/// A deflection map as a picture of at most `most_cells` cells.
///
/// A cell is the mean of k by k pixels (those that count; missing where none does), k = 1 where the
/// map is small enough. The step is half the noise of one pixel, more where the counts would exceed
/// MapPicture::kLargest: what is read back lies within half a step of the mean.
///
/// @param most_cells  at least 1.
MapPicture picture_deflection(const DeflectionMap& map, Index most_cells);

}  // namespace manoscope::maps
