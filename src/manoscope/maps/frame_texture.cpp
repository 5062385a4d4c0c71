#include "manoscope/maps/frame_texture.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "manoscope/maps/channel_map.hpp"
#include "manoscope/maps/texture_patch.hpp"
#include "manoscope/numerics/robust.hpp"

namespace manoscope::maps {
namespace {

using namespace texture;

constexpr Index kMostBlocks = 512;

const Row& column_places() {
  static const Row kPlaces = Row::LinSpaced(-0.5F * (kSide - 1), 0.5F * (kSide - 1));
  return kPlaces;
}
float row_place(int r) { return static_cast<float>(r) - 0.5F * static_cast<float>(kSide - 1); }

/// Takes off the linear function that fits the counting pixels best, and zeroes the others.
class LinearPart {
 public:
  explicit LinearPart(const Pixels& counts) : counts_(counts) {
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    for (int r = 0; r < kSide; ++r) {
      const Row& w = counts[at(r)];
      const double n = w.sum(), z = row_place(r), sx = (w * column_places()).sum();
      const double sxx = (w * column_places().square()).sum();
      normal(0, 0) += n;
      normal(0, 1) += sx;
      normal(0, 2) += z * n;
      normal(1, 1) += sxx;
      normal(1, 2) += z * sx;
      normal(2, 2) += z * z * n;
    }
    normal(1, 0) = normal(0, 1);
    normal(2, 0) = normal(0, 2);
    normal(2, 1) = normal(1, 2);
    inverse_ = normal.inverse();
  }
  void take_off(Pixels& values) const {
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    for (int r = 0; r < kSide; ++r) {
      const Row v = counts_[at(r)] * values[at(r)];
      const double sum = v.sum();
      right += Eigen::Vector3d(sum, (v * column_places()).sum(), row_place(r) * sum);
    }
    const Eigen::Vector3f c = (inverse_ * right).cast<float>();
    for (int r = 0; r < kSide; ++r) {
      values[at(r)] =
          counts_[at(r)] * (values[at(r)] - c[0] - c[1] * column_places() - c[2] * row_place(r));
    }
  }

 private:
  static std::size_t at(int r) { return static_cast<std::size_t>(r); }
  const Pixels& counts_;
  Eigen::Matrix3d inverse_;
};

float sum_of(const Pixels& pixels) {
  Row sum = Row::Zero();
  for (const Row& row : pixels) sum += row;
  return sum.sum();
}

/// Every k-th, so that at most `most` remain.
std::vector<Block> thinned(std::vector<Block> blocks, Index most) {
  const auto n = static_cast<Index>(blocks.size());
  if (n <= most) return blocks;
  std::vector<Block> kept;
  for (Index i = 0; i < most; ++i) kept.push_back(blocks[static_cast<std::size_t>(i * n / most)]);
  return kept;
}

}  // namespace

FrameTexture::FrameTexture(const DeflectionMap& reference, Length length, Length width,
                           Length margin)
    : grid_(reference.grid()) {
  const Length beyond =
      margin + static_cast<double>(kReach) * std::max(grid_.pitch_x, grid_.pitch_z);
  const Flags2 rim = rim_mask(grid_, length, width, beyond);
  std::vector<double> spreads;
  for (Index iz = 0; iz + kSide <= grid_.nz; iz += kSide) {
    for (Index ix = 0; ix + kSide <= grid_.nx; ix += kSide) {
      Index count = 0;
      const auto on_rim = rim.block<kSide, kSide>(iz, ix);
      const auto flags = reference.flags().block<kSide, kSide>(iz, ix);
      for (int r = 0; r < kSide; ++r) {
        for (int c = 0; c < kSide; ++c) count += on_rim(r, c) != 0 && flags(r, c) == 0;
      }
      if (static_cast<float>(count) < kFewestPixels) continue;
      Block block;
      block.ix = ix;
      block.iz = iz;
      constexpr double kMiddle = 0.5 * (kSide - 1);
      block.x = grid_.x(ix) + kMiddle * grid_.pitch_x.si() - 0.5 * length.si();
      block.z = grid_.z(iz) + kMiddle * grid_.pitch_z.si();
      block.even = (ix / kSide + iz / kSide) % 2 == 0;
      blocks_.push_back(block);
    }
  }
  blocks_ = thinned(std::move(blocks_), kMostBlocks);
  constexpr double kNanometre = 1e-9;  // any unit in which the heights suit a float
  const auto fill = [&](Block& block) {
    Patch<kSide + 2, kSide + 2> patch(reference, block.iz - 1, block.ix - 1, 1.0 / kNanometre);
    for (int r = 0; r < kSide; ++r) {
      const auto at = static_cast<std::size_t>(r);
      block.height[at] = patch.row(r + 1, 1);
      block.counts[at] = patch.good_row(r + 1, 1);
      for (int c = 0; c < kSide; ++c) {
        if (rim(block.iz + r, block.ix + c) == 0) block.counts[at][c] = 0.0F;
      }
    }
    return patch;
  };
  for (Block& block : blocks_) {
    fill(block);
    Pixels form = block.height;
    LinearPart(block.counts).take_off(form);
    for (Row& row : form) row = row.abs();
    spreads.push_back(kSpreadOfMean * sum_of(form) / sum_of(block.counts));
  }
  if (spreads.empty()) return;
  const auto spread = static_cast<float>(numerics::median(spreads));
  spread_ = spread * kNanometre;
  if (!(spread > 0.0F)) {
    blocks_.clear();
    return;
  }
  for (Block& block : blocks_) {
    auto patch = fill(block);
    const float mean = patch.height.mean();
    for (Row& row : block.height) row /= spread;
    // Dust keeps its place in the residuals, where weights see it, but makes no pattern.
    patch.height = ((patch.height - mean) / spread).max(-kClip).min(kClip);
    for (int r = 0; r < kSide; ++r) {
      const auto at = static_cast<std::size_t>(r);
      std::array<Row, 3> along, steps;
      for (int k = 0; k < 3; ++k) {
        const Row left = patch.row(r + k, 0), middle = patch.row(r + k, 1),
                  right = patch.row(r + k, 2);
        along[static_cast<std::size_t>(k)] = 0.25F * (left + 2.0F * middle + right);
        steps[static_cast<std::size_t>(k)] = 0.5F * (right - left);
      }
      block.pattern[at] = 0.25F * (along[0] + 2.0F * along[1] + along[2]);
      block.along_x[at] = 0.25F * (steps[0] + 2.0F * steps[1] + steps[2]);
      block.along_z[at] = 0.5F * (along[2] - along[0]);
    }
    const LinearPart linear(block.counts);
    linear.take_off(block.pattern);
    linear.take_off(block.along_x);
    linear.take_off(block.along_z);
  }
}

}  // namespace manoscope::maps
