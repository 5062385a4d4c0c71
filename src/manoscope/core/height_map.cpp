#include "manoscope/core/height_map.hpp"

#include <bit>
#include <cstdint>

#include "manoscope/core/error.hpp"
#include "manoscope/core/flags.hpp"

namespace manoscope {

HeightMap::HeightMap(CameraGrid grid, Array2 height)
    : HeightMap(grid, std::move(height), Flags2::Zero(grid.ny, grid.nx)) {}

HeightMap::HeightMap(CameraGrid grid, Array2 height, Flags2 flags)
    : grid_(grid), height_(std::move(height)), flags_(std::move(flags)) {
  MANO_ASSERT(height_.rows() == grid_.ny && height_.cols() == grid_.nx);
  MANO_ASSERT(flags_.rows() == grid_.ny && flags_.cols() == grid_.nx);
  constexpr std::uint64_t kExponent = 0x7ff0000000000000;  // all ones: infinite or no number
  double* const height_at = height_.data();
  FlagBits* const flags_at = flags_.data();
  for (Index i = 0; i < height_.size(); ++i) {
    const auto bits = std::bit_cast<std::uint64_t>(height_at[i]);
    const bool good = (bits & kExponent) != kExponent;
    height_at[i] = std::bit_cast<double>(good ? bits : 0);
    flags_at[i] |= good ? FlagBits{0} : PixelFlag::no_data;
  }
}

}  // namespace manoscope
