#include <gtest/gtest.h>

#include <cmath>

#include "manoscope/io/reader.hpp"
#include "manoscope/io/test_files.hpp"
#include "manoscope/io/test_instrument_files.hpp"
#include "manoscope/io/test_tiff.hpp"

namespace manoscope::io {
namespace {

using testing::big;
using testing::complaint;
using testing::contains;
using testing::literal_lzw;
using testing::literal_packbits;
using testing::little;
using testing::refusal;
using testing::stored_zlib;
using testing::TestFolder;
using testing::tiff_file;
using testing::tiff_floats;
using testing::TiffPage;
using testing::tiled_page;

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

TEST(Tiff, SixtyFourBitFloatsKeepEveryDigit) {
  const TestFolder folder;
  for (const bool is_little : {true, false}) {
    TiffPage page;
    page.bits = 64;
    const double third = 1.0 / 3.0;
    for (const double value : {third, 2.0, 3.0, 4.0, 5.0, std::nan("")}) {
      page.data += is_little ? little(value) : big(value);
    }
    const Channel channel =
        read_channels(folder.write("a.tif", tiff_file({page}, is_little))).front();
    EXPECT_EQ(channel.values(0, 0), third);
    EXPECT_EQ(channel.values(1, 1), 5.0);
    EXPECT_TRUE(std::isnan(channel.values(1, 2)));
  }
}

TEST(Tiff, EveryPackingGivesTheSameHeights) {
  const TestFolder folder;
  const std::string plain = tiff_floats(1.0F);
  struct Packing {
    int method;
    std::string data;
  };
  for (const Packing& packing : {Packing{5, literal_lzw(plain)}, Packing{8, stored_zlib(plain)},
                                 Packing{32946, stored_zlib(plain)},
                                 Packing{32773, literal_packbits(plain.substr(0, 12)) +
                                                    literal_packbits(plain.substr(12))}}) {
    SCOPED_TRACE(packing.method);
    TiffPage page;
    page.compression = packing.method;
    page.data = packing.data;
    const Array2 values = read_channels(folder.write("a.tif", tiff_file({page}))).front().values;
    for (Index i = 0; i < 5; ++i) EXPECT_EQ(values.data()[i], static_cast<double>(i + 1));
    EXPECT_TRUE(std::isnan(values(1, 2)));
  }
}

TEST(Tiff, TilesAreLaidTogetherAndWhatTheyHoldBeyondTheImageIsNotRead) {
  const TestFolder folder;
  for (const bool packed : {false, true}) {
    for (const auto& [nx, ny] : {std::pair{5U, 3U}, std::pair{20U, 18U}, std::pair{16U, 16U}}) {
      TiffPage page = tiled_page(nx, ny);
      if (packed) {
        page.compression = 8;
        for (std::string& tile : page.tiles) tile = stored_zlib(tile);
      }
      const Array2 values = read_channels(folder.write("a.tif", tiff_file({page}))).front().values;
      ASSERT_EQ(values.rows(), ny);
      ASSERT_EQ(values.cols(), nx);
      for (Index i = 0; i < values.size(); ++i) {
        ASSERT_EQ(values.data()[i], static_cast<double>(i)) << nx << ' ' << packed;
      }
    }
  }
}

TEST(Tiff, BigTiffIsReadInBothByteOrdersInStripsAndTiles) {
  const TestFolder folder;
  for (const bool is_little : {true, false}) {
    TiffPage first, second = tiled_page(20, 18, is_little);
    first.data = tiff_floats(1.0F, is_little);
    first.description = "ImageJ=1.53t\nunit=um\nvunit=nm\n";
    first.per_unit_x = first.per_unit_y = 0.5;
    const auto path = folder.write("a.tif", tiff_file({first, second}, is_little, true));
    EXPECT_EQ(find_reader(path).name(), "tiff");
    const auto channels = read_channels(path);
    ASSERT_EQ(channels.size(), 2U);
    EXPECT_DOUBLE_EQ(channels[0].grid.pitch_x.in(um), 2.0);
    EXPECT_DOUBLE_EQ(channels[0].values(1, 1), 5e-9);
    EXPECT_DOUBLE_EQ(channels[1].values(17, 19), 359e-9);
  }
}

/// ImageJ writes stacks beyond 4 GB, and those of its virtual ones, as one page whose frames follow
/// one another without pages of their own.
TiffPage raw_stack(int n_announced, int n_there) {
  TiffPage page;
  for (int i = 0; i < n_there; ++i) page.data += tiff_floats(10.0F * static_cast<float>(i));
  page.description =
      "ImageJ=1.53t\nimages=" + std::to_string(n_announced) + "\nunit=um\nvunit=nm\n";
  page.per_unit_x = page.per_unit_y = 0.5;
  page.strip_bytes = tiff_floats(0.0F).size();
  return page;
}

TEST(Tiff, FramesThatFollowTheOnePageOfAnImageJStackArePages) {
  const TestFolder folder;
  const auto path = folder.write("a.tif", tiff_file({raw_stack(3, 3)}));
  const auto channels = read_channels(path);
  ASSERT_EQ(channels.size(), 3U);
  for (int i = 0; i < 3; ++i) {
    const Channel& frame = channels[static_cast<std::size_t>(i)];
    EXPECT_EQ(frame.name, "page " + std::to_string(i + 1));
    EXPECT_EQ(frame.page, i + 1);
    EXPECT_DOUBLE_EQ(frame.grid.pitch_x.in(um), 2.0);
    EXPECT_DOUBLE_EQ(frame.values(0, 0), 10e-9 * i);
    EXPECT_DOUBLE_EQ(frame.values(1, 1), 5e-9);
    EXPECT_TRUE(frame.warnings.empty());
  }
  EXPECT_DOUBLE_EQ(read_height_map(path.string() + "#3").height()(0, 0), 20e-9);
  EXPECT_TRUE(contains(complaint([&] { read_height_map(path.string() + "#4"); }), "has no page 4"));
  // Big-endian, as ImageJ itself writes.
  TiffPage turned = raw_stack(2, 0);
  turned.data = tiff_floats(1.0F, false) + tiff_floats(7.0F, false);
  EXPECT_DOUBLE_EQ(
      read_height_map((folder.write("b.tif", tiff_file({turned}, false))).string() + "#2")
          .height()(0, 0),
      7e-9);
}

TEST(Tiff, AnImageJStackThatIsCutShortIsRefusedAndAnImageOutOfAStackIsRead) {
  const TestFolder folder;
  EXPECT_TRUE(contains(refusal(folder, "a.tif", tiff_file({raw_stack(40, 2)})),
                       "a stack of 40 images is announced, the file has room for 2"));
  // Programs that take an image out of a stack leave its description: one frame, plain or packed.
  TiffPage alone = raw_stack(40, 1), packed = alone;
  packed.compression = 5;
  packed.data = literal_lzw(alone.data);
  packed.strip_bytes = 0;
  for (const TiffPage& page : {alone, packed}) {
    const auto channels = read_channels(folder.write("b.tif", tiff_file({page})));
    ASSERT_EQ(channels.size(), 1U);
    EXPECT_TRUE(contains(channels[0].warnings.front(), "a stack of 40 images is announced, 1 are"));
  }
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
