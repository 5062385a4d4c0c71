#include "manoscope/maps/response_picture.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "manoscope/core/error.hpp"
#include "manoscope/maps/cell_centres.hpp"
#include "manoscope/maps/channel_map.hpp"
#include "manoscope/maps/level.hpp"

namespace manoscope::maps {

ResponsePicture picture_response(const HeightMap& before, const HeightMap& after,
                                 const ChannelFrame& frame, const std::string& name) {
  constexpr Index kMostX = 256, kMostZ = 96;
  if (!(before.grid() == after.grid())) {
    throw InputError(name, "differs in size or pixel pitch from the other maps",
                     "Take all maps of one experiment with the same camera settings");
  }
  ChannelMap moved = to_channel_frame(after, frame);
  const ChannelMap still = to_channel_frame(before, frame);
  moved.height -= still.height;
  for (Index i = 0; i < moved.flags.size(); ++i) moved.flags.data()[i] |= still.flags.data()[i];
  const ChannelGrid& grid = moved.grid;
  const Length margin = std::max(grid.pitch_x, grid.pitch_z);
  subtract_plane(moved,
                 fit_rim_plane(moved, rim_mask(grid, frame.length, frame.width, margin), name));

  const Index per_x = (grid.nx + kMostX - 1) / kMostX, per_z = (grid.nz + kMostZ - 1) / kMostZ;
  ResponsePicture picture;
  picture.x = cell_centres(grid.nx, per_x, grid.x(0), grid.pitch_x.si());
  picture.z = cell_centres(grid.nz, per_z, grid.z(0), grid.pitch_z.si());
  picture.height = Array2(picture.z.size(), picture.x.size());
  for (Index cz = 0; cz < picture.z.size(); ++cz) {
    for (Index cx = 0; cx < picture.x.size(); ++cx) {
      double sum = 0.0;
      Index n = 0;
      for (Index iz = cz * per_z; iz < std::min(grid.nz, (cz + 1) * per_z); ++iz) {
        for (Index ix = cx * per_x; ix < std::min(grid.nx, (cx + 1) * per_x); ++ix) {
          if (moved.flags(iz, ix) != 0) continue;
          sum += moved.height(iz, ix);
          ++n;
        }
      }
      picture.height(cz, cx) =
          n > 0 ? sum / static_cast<double>(n) : std::numeric_limits<double>::quiet_NaN();
    }
  }
  return picture;
}

}  // namespace manoscope::maps
