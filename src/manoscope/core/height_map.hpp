#pragma once

#include "manoscope/core/arrays.hpp"
#include "manoscope/core/grid.hpp"

namespace manoscope {

/// Heights as an instrument gives them, in the camera's frame.
///
/// Arrays have shape (ny, nx), row-major. Unit: m. Which sign is outward, and where the channel
/// lies, is not known here. A sample counts only where `flags` is 0 (bits of PixelFlag); every
/// counted height is finite.
class HeightMap {
 public:
  /// Flags every height that is not finite as no_data, and stores 0 there.
  /// @throws InternalError if the shape differs from the grid.
  HeightMap(CameraGrid grid, Array2 height);
  /// @throws InternalError if a shape differs from the grid.
  HeightMap(CameraGrid grid, Array2 height, Flags2 flags);

  const CameraGrid& grid() const { return grid_; }
  const Array2& height() const { return height_; }
  const Flags2& flags() const { return flags_; }

 private:
  CameraGrid grid_;
  Array2 height_;
  Flags2 flags_;
};

}  // namespace manoscope
