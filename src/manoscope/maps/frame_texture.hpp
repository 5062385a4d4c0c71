#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "manoscope/core/deflection_map.hpp"
#include "manoscope/core/units.hpp"

namespace manoscope::maps {

/// How the frame's texture lies in one map, against the map of reference.
///
/// What stood at (x, z) stands at x + dx - angle z, z + dz + angle (x - length / 2): the angle has
/// the sign of CentreLine::slope.
struct TextureShift {
  Length x{}, z{};
  double angle = 0.0;  ///< rad; 0, without uncertainty, where the rim does not reach round enough
  Length x_uncertainty{}, z_uncertainty{};  ///< standard
  double angle_uncertainty = 0.0;
  double significance = 0.0;  ///< Student's t of the common texture against none
};

/// Texture of the rigid rim of one map, in blocks of 16 x 16 pixels.
class FrameTexture {
 public:
  static constexpr int kSide = 16;
  using Row = Eigen::Array<float, kSide, 1>;
  using Pixels = std::array<Row, kSide>;
  static Pixels zeros() {
    Pixels pixels;
    pixels.fill(Row::Zero());
    return pixels;
  }

  /// Heights in units of `spread`. `pattern` and the gradients are of the heights smoothed by
  /// (1 2 1) / 4 along both axes (the gradients across their own direction alone), without their
  /// linear part within the block and zero where `counts` is, so that neither forms of the frame
  /// nor long-range noise enter their products.
  struct Block {
    Index ix = 0, iz = 0;     ///< first pixel
    double x = 0.0, z = 0.0;  ///< m, of its middle, from the middle of the channel
    bool even = false;        ///< of the two halves of the rim, as on a chessboard
    Pixels height = zeros(), counts = zeros();  ///< counts: 1 on good pixels of the rim, else 0
    Pixels pattern = zeros();
    Pixels along_x = zeros(), along_z = zeros();  ///< gradient, per pixel
  };

  /// @param margin  beyond the channel, at which the rim begins; four pixels are added, by which
  ///                another map's wall may lie elsewhere.
  FrameTexture(const DeflectionMap& reference, Length length, Length width, Length margin);

  const ChannelGrid& grid() const { return grid_; }
  const std::vector<Block>& blocks() const { return blocks_; }
  double spread() const { return spread_; }  ///< m, robust standard deviation within the blocks

 private:
  ChannelGrid grid_;
  std::vector<Block> blocks_;
  double spread_ = 0.0;
};

/// Finds the shift along and across the flow and the rotation of a map's rim against a reference.
///
///   minimise sum_i w_i [h(x_i + d(x_i; p)) - h_ref(x_i) - m_block]^2,  p = (dx, dz, angle)
///
/// A search over +-4 pixels and rotations that move the ends by +-3 pixels, by correlation on up to
/// 96 blocks, starts a Gauss-Newton iteration: the map is resampled by the cubic through four
/// pixels along either axis; each block keeps a mean m of its own and moves as one; weights are
/// Tukey's biweight (4.685 robust deviations), so that dust that moved, or stayed when the frame
/// moved, does not count. The scores use the gradient of the reference alone, whose noise then does
/// not pull the shift; the matrix J is that of the products of both gradients, which noise does not
/// bias, under the slope psi' of the biweight. The covariance is the sandwich
/// J^-1 (sum_blocks s s^T) J^-T of the blocks' scores s: noise whatever its correlation within a
/// block enters as it is; with it 0.005 pixel for what resampling leaves.
///
/// A shift counts only if (1) the common texture of map and reference is positive by a Student's t
/// of 5 over the blocks of the search and of 6 over all blocks, at the end; (2) the two halves of
/// the rim (black and white squares of a chessboard) agree within four standard uncertainties of
/// their difference; (3) both uncertainties are below 0.1 pixel. Noise, white or correlated, has
/// blocks of either sign: none of 375 pairs of polished frames passes, correlated over up to 16
/// pixels.
///
/// What never moves with the frame but is in every map, such as marks on the instrument's own
/// mirror, is a texture, too, and its shift is nil: only the wall itself can tell
/// (combine_shifts()).
///
/// Source: Lucas & Kanade 1981, "An iterative image registration technique with an application to
/// stereo vision", eq. (5), with block means, robust weights, and scores and matrix from two
/// images; Baker & Matthews 2004, "Lucas-Kanade 20 years on", for the gradient of the reference;
/// the covariance after White 1980 by blocks. Accuracy on a texture of 50 nm with a correlation
/// length of 3 pixels under noise of 20 nm: 0.02 pixel. Validity: shifts up to 4 pixels; textures
/// with a correlation length of 2 pixels or more (at 1 pixel resampling leaves up to 0.02 pixel,
/// twice the uncertainty); 24 blocks or more, which needs a rim of some 14 pixels beyond its margin
/// on two sides.
/// @return none where no texture stands clear of the noise.
/// @pre the grids are equal.
std::optional<TextureShift> find_texture_shift(const FrameTexture& reference,
                                               const DeflectionMap& map);

}  // namespace manoscope::maps
