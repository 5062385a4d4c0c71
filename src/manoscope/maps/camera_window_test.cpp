#include "manoscope/maps/camera_window.hpp"

#include <gtest/gtest.h>

#include "manoscope/core/error.hpp"
#include "manoscope/core/flags.hpp"

namespace manoscope::maps {
namespace {

/// Heights that tell their pixel of the camera: 100 row + column.
HeightMap seen_through(Index offset_x, Index offset_y, Index nx, Index ny) {
  Array2 height(ny, nx);
  for (Index iy = 0; iy < ny; ++iy) {
    for (Index ix = 0; ix < nx; ++ix) {
      height(iy, ix) = static_cast<double>(100 * (iy + offset_y) + ix + offset_x);
    }
  }
  return {CameraGrid{nx, ny, 2.0 * um, 3.0 * um}, std::move(height)};
}

TEST(IntoWindow, EveryPixelKeepsItsPlaceInTheCamera) {
  const CameraWindow window{CameraGrid{8, 5, 2.0 * um, 3.0 * um}, 20, 10};
  struct Case {
    Index offset_x, offset_y, nx, ny;
  };
  // Of the same size to either side; smaller, inside; larger on all sides.
  for (const Case& own : {Case{23, 9, 8, 5}, Case{17, 12, 8, 5}, Case{22, 11, 3, 2},
                          Case{15, 5, 20, 20}, Case{20, 10, 8, 5}}) {
    const HeightMap map = into_window(seen_through(own.offset_x, own.offset_y, own.nx, own.ny),
                                      own.offset_x, own.offset_y, window, "a");
    ASSERT_EQ(map.grid(), window.grid);
    for (Index iy = 0; iy < 5; ++iy) {
      for (Index ix = 0; ix < 8; ++ix) {
        const Index column = ix + 20, row = iy + 10;
        const bool seen = column >= own.offset_x && column < own.offset_x + own.nx &&
                          row >= own.offset_y && row < own.offset_y + own.ny;
        ASSERT_EQ(map.flags()(iy, ix), seen ? 0 : PixelFlag::no_data) << column << ' ' << row;
        if (seen) {
          ASSERT_EQ(map.height()(iy, ix), static_cast<double>(100 * row + column));
        }
      }
    }
  }
}

TEST(IntoWindow, MissingPixelsMoveWithTheMap) {
  Array2 height = Array2::Constant(2, 2, 1.0);
  Flags2 flags = Flags2::Zero(2, 2);
  flags(0, 1) = PixelFlag::no_data;
  const CameraGrid grid{2, 2, 2.0 * um, 3.0 * um};
  const HeightMap moved = into_window({grid, height, flags}, 1, 0, {grid, 0, 0}, "a");
  EXPECT_EQ(moved.flags()(0, 0), PixelFlag::no_data);  // not seen
  EXPECT_EQ(moved.flags()(1, 1), 0);
  const HeightMap back = into_window({grid, height, flags}, -1, 0, {grid, 0, 0}, "a");
  EXPECT_EQ(back.flags()(0, 0), PixelFlag::no_data);  // missing there already
}

TEST(IntoWindow, WindowsApartAndOtherPixelsAreRefused) {
  const CameraWindow window{CameraGrid{8, 5, 2.0 * um, 3.0 * um}, 20, 10};
  EXPECT_THROW(static_cast<void>(into_window(seen_through(28, 10, 8, 5), 28, 10, window, "a")),
               InputError);
  const CameraWindow finer{CameraGrid{8, 5, 1.0 * um, 3.0 * um}, 20, 10};
  EXPECT_THROW(static_cast<void>(into_window(seen_through(20, 10, 8, 5), 20, 10, finer, "a")),
               InputError);
}

}  // namespace
}  // namespace manoscope::maps
