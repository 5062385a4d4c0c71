#include "manoscope/maps/channel_map.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "manoscope/core/flags.hpp"
#include "tests/support/synthetic_map.hpp"

namespace manoscope::maps {
namespace {

using test_support::channel_from_camera;
using test_support::frame_at;
using test_support::MapErrors;
using test_support::synthetic_map;

constexpr FlowDirection kDirections[] = {FlowDirection::plus_columns, FlowDirection::minus_columns,
                                         FlowDirection::plus_rows, FlowDirection::minus_rows};

/// A wall without any symmetry, so that no swapped axis or sign goes unseen.
double lopsided(double x, double z) {
  return 1e-6 * (std::sin(400.0 * x + 0.3) + 0.5 * std::cos(1100.0 * z + 900.0 * x) + 300.0 * z);
}

CameraGrid camera_for(bool along_columns, Index scale = 1) {
  const double fine = 1.0 / static_cast<double>(scale);
  CameraGrid grid{48 * scale, 13 * scale, 100.0 * fine * um, 70.0 * fine * um};
  if (!along_columns) {
    std::swap(grid.nx, grid.ny);
    std::swap(grid.pitch_x, grid.pitch_y);
  }
  return grid;
}

TEST(ToChannelFrame, PutsTheWallAtItsOwnPlaceInEveryOrientation) {
  for (const FlowDirection flow : kDirections) {
    for (const bool reversed : {false, true}) {
      for (const Outward outward : {Outward::plus_height, Outward::minus_height}) {
        ChannelFrame frame = frame_at(4.0 * mm, 0.6 * mm, flow, reversed, 0.21 * mm, 0.13 * mm);
        frame.outward = outward;
        const CameraGrid camera = camera_for(frame.along_columns());
        RandomStream stream(1, "unused");
        const ChannelMap map =
            to_channel_frame(synthetic_map(camera, frame, lopsided, {}, stream), frame);
        ASSERT_EQ(map.grid.nx, 48);
        ASSERT_EQ(map.grid.nz, 13);
        EXPECT_EQ(map.grid.pitch_x, 100.0 * um);
        EXPECT_EQ(map.grid.pitch_z, 70.0 * um);
        for (Index iz = 0; iz < map.grid.nz; ++iz) {
          for (Index ix = 0; ix < map.grid.nx; ++ix) {
            // Pixels are moved, not interpolated: round-off of positions of 5 mm only.
            ASSERT_NEAR(map.height(iz, ix), lopsided(map.grid.x(ix), map.grid.z(iz)), 1e-19 * 1e5)
                << iz << ' ' << ix << " flow " << static_cast<int>(flow) << reversed;
            ASSERT_EQ(map.flags(iz, ix), 0);
          }
        }
      }
    }
  }
}

TEST(ToChannelFrame, MovesFlagsWithTheirPixels) {
  for (const FlowDirection flow : kDirections) {
    for (const bool reversed : {false, true}) {
      const ChannelFrame frame = frame_at(4.0 * mm, 0.6 * mm, flow, reversed, 0.21 * mm, 0.13 * mm);
      const CameraGrid camera = camera_for(frame.along_columns());
      Flags2 flags = Flags2::Zero(camera.ny, camera.nx);
      const Index iy = 3, ix = 7;
      flags(iy, ix) = PixelFlag::spike;
      const ChannelMap map =
          to_channel_frame(HeightMap(camera, Array2::Zero(camera.ny, camera.nx), flags), frame);
      const auto at =
          channel_from_camera(frame, 7.5 * camera.pitch_x.si(), 3.5 * camera.pitch_y.si());
      Index found = 0;
      for (Index jz = 0; jz < map.grid.nz; ++jz) {
        for (Index jx = 0; jx < map.grid.nx; ++jx) {
          if (map.flags(jz, jx) == 0) continue;
          ++found;
          EXPECT_EQ(map.flags(jz, jx), PixelFlag::spike);
          EXPECT_NEAR(map.grid.x(jx), at.x, 1e-12);  // round-off of millimetres, with room
          EXPECT_NEAR(map.grid.z(jz), at.z, 1e-12);
        }
      }
      EXPECT_EQ(found, 1);
    }
  }
}

TEST(ToChannelFrame, SwapsBothReversalsBack) {
  // A frame seen from the opposite corner, both axes reversed, holds the same wall turned by 180
  // degrees: the sample at (x, z) becomes the one at (l - x, -z).
  const ChannelFrame a =
      frame_at(4.0 * mm, 0.6 * mm, FlowDirection::plus_columns, false, 0.21 * mm, 0.13 * mm);
  const ChannelFrame b =
      frame_at(4.0 * mm, 0.6 * mm, FlowDirection::minus_columns, true, 0.21 * mm, 0.13 * mm);
  const CameraGrid camera = camera_for(true);
  RandomStream stream(1, "unused");
  const HeightMap heights = synthetic_map(camera, a, lopsided, {}, stream);
  const ChannelMap one = to_channel_frame(heights, a), other = to_channel_frame(heights, b);
  EXPECT_TRUE((one.height.reverse() == other.height).all());
  EXPECT_NEAR(one.grid.x(0), 4e-3 - other.grid.x(47), 1e-15);
  EXPECT_NEAR(one.grid.z(0), -other.grid.z(12), 1e-15);
}

double rms_rotated_error(const ChannelFrame& frame, Index scale) {
  RandomStream stream(1, "unused");
  const ChannelMap map = to_channel_frame(
      synthetic_map(camera_for(frame.along_columns(), scale), frame, lopsided, {}, stream), frame);
  double sum = 0.0, n = 0.0;
  for (Index iz = 0; iz < map.grid.nz; ++iz) {
    for (Index ix = 0; ix < map.grid.nx; ++ix) {
      if (map.flags(iz, ix) != 0) continue;
      const double error = map.height(iz, ix) - lopsided(map.grid.x(ix), map.grid.z(iz));
      sum += error * error;
      n += 1.0;
    }
  }
  return std::sqrt(sum / n);
}

TEST(ToChannelFrame, ConvergesAtSecondOrderUnderRotation) {
  for (const FlowDirection flow : kDirections) {
    for (const double degrees : {0.3, -1.0}) {
      ChannelFrame frame = frame_at(4.0 * mm, 0.6 * mm, flow, false, 0.21 * mm, 0.13 * mm);
      frame.rotation = degrees * deg;
      // Fine enough for the rotation to carry samples through every phase between two pixels.
      const double coarse = rms_rotated_error(frame, 16), fine = rms_rotated_error(frame, 32);
      // Bilinear: order 2. Not every phase is met equally often: the ratio is 4 within 10 %.
      EXPECT_NEAR(std::log2(coarse / fine), 2.0, 0.15) << degrees;
      // At most d^2/8 times the second derivatives, 1e-6 (400^2 + 0.5 (900^2 + 1100^2)) per m.
      const double pitch = 100e-6 / 16.0;
      EXPECT_LT(coarse, 0.125 * pitch * pitch * 1.2);
    }
  }
}

TEST(ToChannelFrame, KeepsAPlaneExactlyUnderRotation) {
  const auto plane = [](double x, double z) { return 1e-6 + 2e-3 * x - 3e-3 * z; };
  for (const FlowDirection flow : kDirections) {
    ChannelFrame frame = frame_at(4.0 * mm, 0.6 * mm, flow, true, 0.21 * mm, 0.13 * mm);
    frame.rotation = -1.0 * deg;
    RandomStream stream(1, "unused");
    const ChannelMap map = to_channel_frame(
        synthetic_map(camera_for(frame.along_columns()), frame, plane, {}, stream), frame);
    Index good = 0;
    for (Index iz = 0; iz < map.grid.nz; ++iz) {
      for (Index ix = 0; ix < map.grid.nx; ++ix) {
        if (map.flags(iz, ix) != 0) continue;
        ++good;
        // Bilinear interpolation is exact for a plane: round-off of 20 um.
        EXPECT_NEAR(map.height(iz, ix), plane(map.grid.x(ix), map.grid.z(iz)), 1e-19);
      }
    }
    EXPECT_GT(good, map.flags.size() * 8 / 10);  // 1 degree carries a wedge of 80 um out of view
  }
}

TEST(ToChannelFrame, FlagsWhatRotationTakesFromBeyondTheMapOrFromABadPixel) {
  ChannelFrame frame =
      frame_at(4.0 * mm, 0.6 * mm, FlowDirection::plus_columns, false, 0.21 * mm, 0.13 * mm);
  const CameraGrid camera = camera_for(true);
  Array2 height = Array2::Zero(camera.ny, camera.nx);
  height(6, 20) = std::numeric_limits<double>::quiet_NaN();
  for (const double degrees : {0.3, -1.0, -20.0, 90.0}) {
    frame.rotation = degrees * deg;
    const ChannelMap map = to_channel_frame(HeightMap(camera, height), frame);
    for (Index iz = 0; iz < map.grid.nz; ++iz) {
      for (Index ix = 0; ix < map.grid.nx; ++ix) {
        const auto [column, row] = frame.camera_from_channel(map.grid.x(ix), map.grid.z(iz));
        const double i = column / camera.pitch_x.si() - 0.5, j = row / camera.pitch_y.si() - 0.5;
        const bool beyond = i < -0.5 || i > 47.5 || j < -0.5 || j > 12.5;
        const bool beside = std::abs(i - 20.0) < 1.0 && std::abs(j - 6.0) < 1.0;
        EXPECT_EQ(map.flags(iz, ix), beyond || beside ? PixelFlag::no_data : FlagBits{0})
            << degrees << ": " << i << ", " << j;
        EXPECT_EQ(map.height(iz, ix), 0.0);
      }
    }
  }
}

TEST(RimMask, HoldsEverySampleFartherThanTheMarginFromTheRectangle) {
  const ChannelGrid grid{60, 20, 100.0 * um, 100.0 * um, -1.05 * mm, -0.95 * mm};
  const Flags2 rim = rim_mask(grid, 4.0 * mm, 1.0 * mm, 0.3 * mm);
  Index count = 0;
  for (Index iz = 0; iz < grid.nz; ++iz) {
    for (Index ix = 0; ix < grid.nx; ++ix) {
      const double beyond_x = std::max(-grid.x(ix), grid.x(ix) - 4e-3);
      const double beyond_z = std::abs(grid.z(iz)) - 0.5e-3;
      EXPECT_EQ(rim(iz, ix), std::max(beyond_x, beyond_z) > 0.3e-3 ? 1 : 0);
      count += rim(iz, ix);
    }
  }
  // Samples at -1.05 mm + 0.1 i: 46 lie in (-0.3, 4.3) mm; at -0.95 mm + 0.1 k: 16 in +-0.8 mm.
  EXPECT_EQ(count, 60 * 20 - 46 * 16);
}

TEST(RimMask, FollowsACentreLineOffTheAxisAndAskew) {
  const ChannelGrid grid{60, 20, 100.0 * um, 100.0 * um, -1.05 * mm, -0.95 * mm};
  for (const CentreLine& centre :
       {CentreLine{0.12 * mm, 0.0}, CentreLine{-0.04 * mm, 0.07}, CentreLine{0.3 * mm, -0.21}}) {
    const Flags2 rim = rim_mask(grid, 4.0 * mm, 1.0 * mm, 0.3 * mm, centre);
    for (Index iz = 0; iz < grid.nz; ++iz) {
      for (Index ix = 0; ix < grid.nx; ++ix) {
        const double beyond_x = std::max(-grid.x(ix), grid.x(ix) - 4e-3);
        const double beyond_z = std::abs(grid.z(iz) - centre.z(grid.x(ix), 4e-3)) - 0.5e-3;
        EXPECT_EQ(rim(iz, ix), std::max(beyond_x, beyond_z) > 0.3e-3 ? 1 : 0) << iz << ' ' << ix;
      }
    }
  }
}

}  // namespace
}  // namespace manoscope::maps
