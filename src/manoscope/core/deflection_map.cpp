#include "manoscope/core/deflection_map.hpp"

#include "manoscope/core/error.hpp"

namespace manoscope {

DeflectionMap::DeflectionMap(ChannelGrid grid, Array2 zeta, Flags2 flags, Length noise,
                             double noise_length_x, double noise_length_z)
    : grid_(grid),
      zeta_(std::move(zeta)),
      flags_(std::move(flags)),
      noise_(noise),
      noise_length_x_(noise_length_x),
      noise_length_z_(noise_length_z) {
  MANO_ASSERT(zeta_.rows() == grid_.nz && zeta_.cols() == grid_.nx);
  MANO_ASSERT(flags_.rows() == grid_.nz && flags_.cols() == grid_.nx);
  MANO_ASSERT(noise_ >= Length{} && noise_length_x_ >= 1.0 && noise_length_z_ >= 1.0);
}

}  // namespace manoscope
