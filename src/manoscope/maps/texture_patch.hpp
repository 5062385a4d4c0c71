#pragma once

#include <algorithm>

#include "manoscope/maps/frame_texture.hpp"

// For frame_texture.cpp and texture_shift.cpp alone.
namespace manoscope::maps::texture {

constexpr int kSide = FrameTexture::kSide;
using Row = FrameTexture::Row;
using Pixels = FrameTexture::Pixels;
using Block = FrameTexture::Block;

constexpr int kReach = 4;                 // pixels of shift along either axis
constexpr float kFewestPixels = 96.0F;    // of a block
constexpr float kClip = 5.0F;             // spreads: higher is dust
constexpr double kSpreadOfMean = 1.2533;  // normal: standard deviation by mean absolute one

/// Pixels of a map about a block, per spread; bad ones filled in from those around.
template <int Rows, int Columns>
struct Patch {
  Eigen::Array<float, Rows, Columns, Eigen::RowMajor> height, good;
  float share_bad = 0.0F;

  Patch(const DeflectionMap& map, Index iz, Index ix, double scale) {
    const Index nz = map.grid().nz, nx = map.grid().nx;
    float sum = 0.0F, count = 0.0F;
    for (int r = 0; r < Rows; ++r) {
      const Index jz = iz + r;
      for (int c = 0; c < Columns; ++c) {
        const Index jx = ix + c;
        const bool inside = jz >= 0 && jz < nz && jx >= 0 && jx < nx;
        const bool counts = inside && map.flags()(jz, jx) == 0;
        height(r, c) = counts ? static_cast<float>(map.zeta()(jz, jx) * scale) : 0.0F;
        good(r, c) = counts ? 1.0F : 0.0F;
        sum += height(r, c);
        count += good(r, c);
      }
    }
    if (count == static_cast<float>(Rows * Columns)) return;
    share_bad = 1.0F - count / static_cast<float>(Rows * Columns);
    const float mean = count > 0.0F ? sum / count : 0.0F;
    for (int r = 0; r < Rows; ++r) {
      for (int c = 0; c < Columns; ++c) {
        if (good(r, c) == 0.0F) height(r, c) = filled(r, c, mean);
      }
    }
  }

  float filled(int row, int column, float otherwise) const {
    float sum = 0.0F, count = 0.0F;
    for (int r = std::max(0, row - 1); r <= std::min(Rows - 1, row + 1); ++r) {
      for (int c = std::max(0, column - 1); c <= std::min(Columns - 1, column + 1); ++c) {
        sum += good(r, c) * height(r, c);
        count += good(r, c);
      }
    }
    return count > 0.0F ? sum / count : otherwise;
  }

  auto row(int r, int c) const { return Eigen::Map<const Row>(&height(r, c)); }
  auto good_row(int r, int c) const { return Eigen::Map<const Row>(&good(r, c)); }
};

}  // namespace manoscope::maps::texture
