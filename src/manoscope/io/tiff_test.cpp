#include <gtest/gtest.h>

#include <cmath>

#include "manoscope/io/reader.hpp"
#include "manoscope/io/test_files.hpp"
#include "manoscope/io/test_tiff.hpp"

namespace manoscope::io {
namespace {

using testing::big;
using testing::complaint;
using testing::contains;
using testing::little;
using testing::refusal;
using testing::TestFolder;
using testing::tiff_file;
using testing::tiff_floats;
using testing::TiffPage;

TEST(Tiff, ReadsFloatsInBothByteOrdersTopRowFirst) {
  const TestFolder folder;
  for (const bool is_little : {true, false}) {
    TiffPage page;
    page.data = tiff_floats(1.0F, is_little);
    page.description = "ImageJ=1.53t\nunit=\\u00B5m\nvunit=nm\n";
    page.per_unit_x = 0.5;
    page.per_unit_y = 0.25;
    const HeightMap map = read_height_map(folder.write("a.tif", tiff_file({page}, is_little)));
    EXPECT_EQ(map.grid().nx, 3);
    EXPECT_DOUBLE_EQ(map.grid().pitch_x.in(um), 2.0);
    EXPECT_DOUBLE_EQ(map.grid().pitch_y.in(um), 4.0);
    EXPECT_DOUBLE_EQ(map.height()(0, 2), 3e-9);
    EXPECT_DOUBLE_EQ(map.height()(1, 0), 4e-9);
    EXPECT_NE(map.flags()(1, 2), 0);
  }
}

TEST(Tiff, IntegersTakeTheCalibrationOfTheDescription) {
  const TestFolder folder;
  struct Case {
    int bits, format;
    double last;
  };
  for (const Case& test : {Case{16, 1, 65534.0}, Case{16, 2, -2.0}, Case{32, 2, -2.0},
                           Case{8, 1, 254.0}, Case{32, 1, 4294967294.0}}) {
    TiffPage page;
    page.bits = test.bits;
    page.format = test.format;
    for (const std::uint64_t value : {1ULL, 2ULL, 3ULL, 4ULL, 5ULL, ~1ULL}) {
      page.data += little(value, test.bits / 8);
    }
    page.description = "ImageJ=1.53t\ncf=0\nc0=-10\nc1=0.5\nvunit=um\n";
    const Channel channel = read_channels(folder.write("a.tif", tiff_file({page}))).front();
    EXPECT_EQ(channel.unit, "m");
    EXPECT_NEAR(channel.values(0, 0), -9.5e-6, 1e-20) << test.bits;
    EXPECT_NEAR(channel.values(1, 2), (-10 + 0.5 * test.last) * 1e-6, 1e-14) << test.bits;
  }
  TiffPage bent;
  bent.data = tiff_floats(1.0F);
  bent.description = "ImageJ=1.53t\ncf=4\nc0=-10\nc1=0.5\n";
  EXPECT_TRUE(contains(refusal(folder, "a.tif", tiff_file({bent})), "no straight line"));
}

TEST(Tiff, PagesAreChannelsAndPicturesAreNot) {
  const TestFolder folder;
  TiffPage first, second, colours;
  first.data = tiff_floats(1.0F);
  second.data = tiff_floats(7.0F);
  colours.bits = 8;
  colours.format = 1;
  colours.data = "123456";
  const auto channels = read_channels(folder.write("a.tif", tiff_file({first, colours, second})));
  ASSERT_EQ(channels.size(), 2U);
  EXPECT_EQ(channels[1].name, "page 3");
  EXPECT_EQ(channels[1].values(0, 0), 7.0);
  EXPECT_TRUE(contains(refusal(folder, "b.tif", tiff_file({colours})), "no heights"));
}

TEST(Tiff, OnlyRealScalesAreTaken) {
  const TestFolder folder;
  TiffPage page;
  page.data = tiff_floats(1.0F);
  const auto channel = [&](const ReadOptions& options = {}) {
    return read_channels(folder.write("a.tif", tiff_file({page})), options).front();
  };
  EXPECT_EQ(channel().grid.pitch_x, Length{});
  page.per_unit_x = page.per_unit_y = 5000.0;
  EXPECT_EQ(channel().grid.pitch_x, Length{});  // no unit
  ReadOptions options;
  options.lateral_unit = "mm";
  EXPECT_DOUBLE_EQ(channel(options).grid.pitch_x.in(um), 0.2);
  page.resolution_unit = 3;
  EXPECT_DOUBLE_EQ(channel().grid.pitch_x.in(um), 2.0);
  page.resolution_unit = 2;
  EXPECT_DOUBLE_EQ(channel().grid.pitch_x.in(um), 5.08);
  page.per_unit_x = page.per_unit_y = 72.0;
  EXPECT_EQ(channel().grid.pitch_x, Length{});
  EXPECT_TRUE(contains(channel().warnings.front(), "screen or printer"));
}

TEST(Tiff, TheOrientationTagTurnsTheMap) {
  const TestFolder folder;
  TiffPage page;
  page.data = tiff_floats(1.0F);
  page.orientation = 4;
  EXPECT_EQ(read_channels(folder.write("a.tif", tiff_file({page}))).front().values(1, 0), 1.0);
  page.orientation = 2;
  EXPECT_EQ(read_channels(folder.write("a.tif", tiff_file({page}))).front().values(0, 2), 1.0);
}

TEST(Tiff, WhatDoesNotFitIsRefused) {
  const TestFolder folder;
  const auto fault = [&](TiffPage page, std::size_t cut = 0) {
    if (page.data.empty()) page.data = tiff_floats(1.0F);
    const std::string bytes = tiff_file({page});
    return complaint(
        [&] { read_channels(folder.write("a.tif", bytes.substr(0, bytes.size() - cut))); });
  };
  EXPECT_EQ(fault({}), "");
  TiffPage page;
  page.nx = 1000000;
  page.ny = 1000;
  EXPECT_TRUE(contains(fault(page), "announces 1000000 x 1000 pixels"));
  page.compression = 5;
  EXPECT_TRUE(contains(fault(page), "announces 1000000 x 1000 pixels"));
  page = {};
  page.compression = 7;
  EXPECT_TRUE(contains(fault(page), "packed by method 7"));
  page = {};
  page.format = 5;
  EXPECT_TRUE(contains(fault(page), "samples of 32 bits, format 5"));
  page = {};
  page.compression = 8;
  page.data = std::string(20, '\1');
  EXPECT_TRUE(contains(fault(page), "cannot be read"));
  EXPECT_TRUE(contains(fault({}, 60), "a.tif"));
  // Pages that all claim the same bytes.
  std::vector<TiffPage> pages(40);
  pages[0].data = std::string(24, '\0');
  for (TiffPage& each : pages) {
    each.nx = 100;
    each.ny = 100;
  }
  EXPECT_TRUE(contains(refusal(folder, "a.tif", tiff_file(pages)), "announces"));
}

}  // namespace
}  // namespace manoscope::io
