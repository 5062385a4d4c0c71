#pragma once

#include <cstdint>

#include "manoscope/core/flags.hpp"
#include "manoscope/core/grid.hpp"
#include "manoscope/twin/interferometer_options.hpp"

namespace manoscope::twin {

/// Which map of which experiment: every random error is a function of these and its own name.
struct MapKey {
  std::uint64_t seed = 1, index = 0;
};

/// Adds what the instrument adds to a true height, in this order: the form of the frame
/// (curvature), white and correlated noise, false heights (spikes), patches of a false fringe
/// order; then rounds to steps.
///
/// @param height  (ny, nx) m, changed in place.
void add_height_errors(const InterferometerOptions& options, const CameraGrid& grid,
                       const MapKey& key, Array2& height);

/// Pixels without a height: (ny, nx), PixelFlag::no_data where one is lost, singly or in a blob.
Flags2 lost_pixels(const InterferometerOptions& options, const CameraGrid& grid, const MapKey& key);

}  // namespace manoscope::twin
