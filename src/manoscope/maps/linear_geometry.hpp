// Where rim and channel lie in the pixels of a map: the inside of LinearReducer.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "manoscope/core/arrays.hpp"
#include "manoscope/maps/channel_map.hpp"
#include "manoscope/maps/column_weights.hpp"
#include "manoscope/maps/linear_reduction.hpp"

namespace manoscope::maps {

/// Normal matrix of a plane through points (a, b).
inline Eigen::Matrix3d normal_matrix(double n, double a, double b, double aa, double ab,
                                     double bb) {
  Eigen::Matrix3d matrix;
  matrix << n, a, b, a, aa, ab, b, ab, bb;
  return matrix;
}

/// In the order of the camera's pixels: rows and columns as they lie in the file. Where the
/// channel's axes run the other way, x falls along the columns, and z is counted backwards.
struct LinearReducer::Geometry {
  CameraGrid camera;
  ChannelGrid grid;  ///< of the pixels in their own order; z times `across`
  double width = 0.0, flow = 1.0, across = 1.0, outward = 1.0;
  ColumnWeights weights;
  Array1 x, a, b;  ///< of the columns, m and scaled; of the rows, scaled
  double x_centre = 0.0, scale_x = 1.0, scale_z = 1.0;
  Index first = 0, end = 0;  ///< columns inside the channel
  /// Columns beyond the channel's ends, in rows beside it: [0, left) and [right, nx).
  Index left = 0, right = 0;
  Index rim_below = 0, rim_above = 0;  ///< rows [0, below) and [above, nz) are rim all along
  Eigen::Matrix3d normal;              ///< of the rim's plane, no pixel missing
  /// Rows [inner_begin, inner_end) all have the same weight in a width average.
  Index inner_begin = 0, inner_end = 0;
  double inner_weight = 0.0;
  /// A word to kLanes columns, each of its bytes with a bit to a column: of those inside the
  /// channel, of all that the map has, and of those beyond the channel's ends.
  std::vector<std::uint64_t> inside, in_map, beyond_ends;
  WidthAverageOptions options;

  bool is_rim_row(Index iz) const { return iz < rim_below || iz >= rim_above; }
  bool is_inner_row(Index iz) const { return iz >= inner_begin && iz < inner_end; }
  /// Rows from this one on of which the same pixels count, those of inner rows with one weight.
  Index rows_alike(Index iz) const;

  Geometry(const CameraGrid& map, const ChannelFrame& frame, const std::string& name,
           const LinearReductionOptions& given);

 private:
  static ChannelGrid in_pixel_order(const CameraGrid& camera, const ChannelFrame& frame) {
    ChannelGrid grid = channel_grid(camera, frame);
    if (frame.across_sign() < 0.0) grid.z0 = Length::from_si(-grid.z(grid.nz - 1));
    return grid;
  }
};

}  // namespace manoscope::maps
