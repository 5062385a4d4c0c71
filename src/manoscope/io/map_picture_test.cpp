#include "manoscope/io/map_picture.hpp"

#include <gtest/gtest.h>
#include <png.h>

#include <limits>

#include "manoscope/io/test_files.hpp"

namespace manoscope::io {
namespace {

constexpr Rgb kGrey{128, 128, 128};

TEST(MapPicture, KeepsTheSidesOfTheMapAndItsTopRow) {
  // 100 x 50 pixels, twice as high as wide each: a square.
  Array2 values = Array2::Zero(50, 100);
  values.topRows(25) = 1.0;
  const MapPicture picture = picture_of(CameraGrid{100, 50, 1.0 * um, 2.0 * um}, values, 64);
  EXPECT_EQ(picture.width, 64);
  EXPECT_EQ(picture.height, 64);
  EXPECT_EQ(picture.pixels.front(), viridis(1.0));
  EXPECT_EQ(picture.pixels.back(), viridis(0.0));
  const MapPicture bare = picture_of(CameraGrid{100, 50, {}, {}}, values, 64);
  EXPECT_EQ(bare.height, 32);
}

TEST(MapPicture, MissingPixelsAreGreyAndASpikeHidesNothing) {
  Array2 values(100, 100);
  for (Index i = 0; i < values.size(); ++i) values.data()[i] = static_cast<double>(i % 100);
  values(99, 99) = 1e9;
  values.row(0) = std::numeric_limits<double>::quiet_NaN();
  const CameraGrid grid{100, 100, 1.0 * um, 1.0 * um};
  const MapPicture picture = picture_of(grid, values, 100);
  EXPECT_EQ(picture.pixels[50], kGrey);
  const Rgb middle = picture.pixels[5050];
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(middle[i], viridis(0.505)[i], 4);
  const Array2 nothing = Array2::Constant(4, 4, std::numeric_limits<double>::quiet_NaN());
  for (const Rgb& pixel : picture_of(CameraGrid{4, 4, {}, {}}, nothing, 16).pixels) {
    EXPECT_EQ(pixel, kGrey);
  }
}

TEST(MapPicture, ThePngHoldsThePixels) {
  const testing::TestFolder folder;
  MapPicture picture{2, 1, {{1, 2, 3}, {250, 128, 0}}};
  write_png(folder / "a.png", picture);
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  ASSERT_NE(png_image_begin_read_from_file(&image, (folder / "a.png").c_str()), 0);
  EXPECT_EQ(image.width, 2U);
  EXPECT_EQ(image.height, 1U);
  image.format = PNG_FORMAT_RGB;
  std::array<std::uint8_t, 6> pixels{};
  ASSERT_NE(png_image_finish_read(&image, nullptr, pixels.data(), 0, nullptr), 0);
  EXPECT_EQ(pixels, (std::array<std::uint8_t, 6>{1, 2, 3, 250, 128, 0}));
}

TEST(MapPicture, TheTerminalShowsTwoRowsALine) {
  const MapPicture picture{1, 3, {{1, 2, 3}, {4, 5, 6}, {7, 8, 9}}};
  EXPECT_EQ(terminal_text(picture),
            "\x1b[38;2;1;2;3m\x1b[48;2;4;5;6m\xE2\x96\x80\x1b[0m\n"
            "\x1b[38;2;7;8;9m\xE2\x96\x80\x1b[0m\n");
}

}  // namespace
}  // namespace manoscope::io
