#pragma once

#include <string>

#include "manoscope/core/arrays.hpp"
#include "manoscope/core/frame.hpp"
#include "manoscope/core/height_map.hpp"

namespace manoscope::maps {

/// What the wall did between two states, in the camera's frame, leveled on the map's border.
///
/// Arrays have shape (ny, nx). Unit: m. Pixels that are bad in either map hold 0 and are not
/// `good`.
struct Response {
  CameraGrid grid;
  Array2 height;
  Flags2 good;         ///< 1 = counts
  double sigma = 0.0;  ///< m, robust standard deviation on the border
  double top = 0.0;    ///< m, 99.5th percentile of |height|
};

/// after - before, minus the robust plane of the outermost 4 % of the map (at least 3 pixels), with
/// lone spikes along the rows cut down to their neighbours.
/// @throws InputError if the grids differ or the border holds no plane.
Response wall_response(const HeightMap& before, const HeightMap& after, const std::string& name);

/// Ends of the stretch where a profile stands above zero: the straight line through its 10 % and 30
/// % points, extended to zero, at either end. Positions in units of the index.
struct Extent {
  double first = 0.0, last = 0.0;
  bool found = false;
};
Extent extent_of(const Array1& profile);

}  // namespace manoscope::maps
