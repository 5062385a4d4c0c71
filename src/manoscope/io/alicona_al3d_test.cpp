#include <gtest/gtest.h>

#include <cmath>

#include "manoscope/io/formats.hpp"
#include "manoscope/io/test_confocal_files.hpp"
#include "manoscope/io/test_files.hpp"

namespace manoscope::io {
namespace {

using testing::AliconaAl3d;
using testing::contains;
using testing::refusal;
using testing::TestFolder;

TEST(AliconaAl3d, ReadsPaddedRowsAndMarksInvalidPixels) {
  const TestFolder folder;
  const auto channels = read_channels(folder.write("a.al3d", AliconaAl3d().bytes()));
  ASSERT_EQ(channels.size(), 3U);
  const Channel& depth = channels.front();
  EXPECT_EQ(depth.unit, "m");
  EXPECT_DOUBLE_EQ(depth.grid.pitch_x.si(), 4e-7);
  EXPECT_DOUBLE_EQ(depth.grid.pitch_y.si(), 5e-7);
  EXPECT_EQ(depth.values(0, 0), static_cast<double>(1e-3F));
  EXPECT_EQ(depth.values(1, 0), static_cast<double>(4e-3F));
  EXPECT_TRUE(std::isnan(depth.values(1, 1)));  // the tag has fewer digits than the float
  EXPECT_EQ(depth.values(1, 2), static_cast<double>(6e-3F));
  EXPECT_EQ(channels[1].name, "Texture 1");
  EXPECT_EQ(channels[1].unit, "1");
  EXPECT_EQ(channels[1].values(1, 2), 10.0);
  EXPECT_EQ(channels[2].values(0, 0), 16.0);
}

TEST(AliconaAl3d, FaultyFilesAreNamed) {
  const TestFolder folder;
  const auto fault = [&](auto&& spoil) {
    AliconaAl3d file;
    spoil(file);
    return refusal(folder, "a.al3d", file.bytes());
  };
  EXPECT_TRUE(contains(fault([](AliconaAl3d& f) { f.cols = "three"; }), "its Cols is \"three\""));
  EXPECT_TRUE(contains(fault([](AliconaAl3d& f) { f.cols = "-3"; }), "its Cols is -3"));
  EXPECT_TRUE(contains(fault([](AliconaAl3d& f) { f.cols = "3000"; }), "only"));
  EXPECT_TRUE(contains(fault([](AliconaAl3d& f) { f.n_planes = 3; }), "byte"));
  EXPECT_TRUE(contains(fault([](AliconaAl3d& f) { f.tag_end = "xx"; }), "end with a new line"));
  EXPECT_TRUE(contains(fault([](AliconaAl3d& f) { f.pitch = "1e9"; }), "pixel of 1e+09 m"));
}

}  // namespace
}  // namespace manoscope::io
