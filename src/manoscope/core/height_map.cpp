#include "manoscope/core/height_map.hpp"

#include <cmath>

#include "manoscope/core/error.hpp"
#include "manoscope/core/flags.hpp"

namespace manoscope {

HeightMap::HeightMap(CameraGrid grid, Array2 height)
    : HeightMap(grid, std::move(height), Flags2::Zero(grid.ny, grid.nx)) {}

HeightMap::HeightMap(CameraGrid grid, Array2 height, Flags2 flags)
    : grid_(grid), height_(std::move(height)), flags_(std::move(flags)) {
  MANO_ASSERT(height_.rows() == grid_.ny && height_.cols() == grid_.nx);
  MANO_ASSERT(flags_.rows() == grid_.ny && flags_.cols() == grid_.nx);
  for (Index i = 0; i < height_.size(); ++i) {
    double& value = height_.data()[i];
    if (!std::isfinite(value)) {
      value = 0.0;
      flags_.data()[i] |= PixelFlag::no_data;
    }
  }
}

}  // namespace manoscope
