#include <gtest/gtest.h>

#include <cmath>

#include "manoscope/io/formats.hpp"
#include "manoscope/io/test_files.hpp"
#include "manoscope/io/test_instrument_files.hpp"

namespace manoscope::io {
namespace {

using testing::complaint;
using testing::contains;
using testing::refusal;
using testing::SurfObject;
using testing::TestFolder;

TEST(DigitalSurf, EveryKindOfPointGivesTheSameHeights) {
  const TestFolder folder;
  for (const bool compressed : {false, true}) {
    for (const int bits : {16, 32}) {
      for (const int format : {0, 257}) {
        SurfObject object;
        object.compressed = compressed;
        object.bits = bits;
        object.format = format;
        const auto channels = read_channels(folder.write("a.sur", object.bytes()));
        ASSERT_EQ(channels.size(), 1U);
        const Channel& height = channels.front();
        EXPECT_EQ(height.name, "Z");
        EXPECT_EQ(height.unit, "m");
        EXPECT_EQ(height.file_unit, "nm");
        EXPECT_DOUBLE_EQ(height.grid.pitch_x.in(um), 1.5);
        EXPECT_DOUBLE_EQ(height.grid.pitch_y.in(um), 2.5);
        for (Index i = 0; i < 6; ++i) {
          // Point times spacing plus offset, 2 nm and 100 nm; round-off of one sum.
          EXPECT_NEAR(height.values(i / 3, i % 3), (2.0 * double(10 + i) + 100.0) * 1e-9, 1e-22);
        }
      }
    }
  }
}

TEST(DigitalSurf, SpecialPointsAreMissingOnlyWhereTheHeaderAnnouncesThem) {
  const TestFolder folder;
  SurfObject object;
  object.points = {8, 9, 10, 15, 16, 12};  // not measured, saturated, lowest, highest, saturated
  const auto plain = read_channels(folder.write("a.sur", object.bytes()));
  EXPECT_EQ(plain[0].values.isNaN().count(), 0);
  object.special_points = true;
  const auto special = read_channels(folder.write("a.sur", object.bytes()));
  const bool missing[6] = {true, true, false, false, true, false};
  for (Index i = 0; i < 6; ++i) {
    EXPECT_EQ(std::isnan(special[0].values.data()[i]), missing[i]) << i;
  }
  object.least = object.most = 10;  // no range: only the mark of what was not measured
  const auto rangeless = read_channels(folder.write("a.sur", object.bytes()));
  EXPECT_EQ(rangeless[0].values.isNaN().count(), 1);
}

TEST(DigitalSurf, ColoursAreChannelsBesideTheHeights) {
  const TestFolder folder;
  SurfObject heights, colour;
  heights.type = 16;
  heights.n_channels = 5;
  colour.type = 10;
  colour.unit_z = "";
  std::string bytes = heights.bytes();
  for (int i = 0; i < 4; ++i) bytes += colour.bytes();
  const auto path = folder.write("a.sur", bytes);
  const auto channels = read_channels(path);
  ASSERT_EQ(channels.size(), 5U);
  const std::array<const char*, 5> names{"Z", "red", "green", "blue", "intensity"};
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_EQ(channels[i].name, names[i]);
    EXPECT_EQ(channels[i].unit, i == 0 ? "m" : "1");
  }
  EXPECT_NO_THROW(read_height_map(path));  // the one channel in metres
}

TEST(DigitalSurf, ASeriesIsOneChannelASurface) {
  const TestFolder folder;
  SurfObject object;
  object.type = 5;
  object.n_objects = 3;
  const auto path = folder.write("a.sur", object.bytes() + object.bytes() + object.bytes());
  const auto channels = read_channels(path);
  ASSERT_EQ(channels.size(), 3U);
  EXPECT_EQ(channels[2].name, "Z 3");
  EXPECT_TRUE(contains(complaint([&] { read_height_map(path); }), "--channel"));
  ReadOptions second;
  second.channel = "Z 2";
  EXPECT_NO_THROW(read_height_map(path, second));
}

TEST(DigitalSurf, AProfileAndAnUnknownUnitAreToldNotTakenForAMap) {
  const TestFolder folder;
  SurfObject object;
  object.type = 1;
  object.nx = 6;
  object.ny = 1;
  const auto profile = folder.write("a.pro", object.bytes());
  EXPECT_TRUE(contains(complaint([&] { read_height_map(profile); }), "a profile, not a map"));
  object = {};
  object.unit_z = "a.u.";
  object.name_z = "CL";
  const auto intensity = folder.write("a.sur", object.bytes());
  EXPECT_TRUE(contains(complaint([&] { read_height_map(intensity); }), "\"CL\" 3 x 2 [a.u.]"));
  object.unit_z = "";
  const auto unitless = folder.write("a.sur", object.bytes());
  EXPECT_TRUE(contains(complaint([&] { read_height_map(unitless); }), "--height-unit"));
}

TEST(DigitalSurf, AnInversionIsReported) {
  const TestFolder folder;
  SurfObject object;
  EXPECT_TRUE(read_channels(folder.write("a.sur", object.bytes()))[0].warnings.empty());
  object.inverted = 1;
  EXPECT_EQ(read_channels(folder.write("a.sur", object.bytes()))[0].warnings.size(), 1U);
}

TEST(DigitalSurf, FaultyFilesAreNamed) {
  const TestFolder folder;
  const auto fault = [&](auto&& spoil) {
    SurfObject object;
    spoil(object);
    return refusal(folder, "a.sur", object.bytes());
  };
  EXPECT_TRUE(contains(fault([](SurfObject& o) { o.bits = 8; }), "points of 8 bits"));
  EXPECT_TRUE(contains(fault([](SurfObject& o) { o.n = 7; }), "announces 3 x 2 = 7 points"));
  EXPECT_TRUE(contains(fault([](SurfObject& o) { o.nx = -3; }), "-3 x 2 pixels"));
  EXPECT_TRUE(contains(fault([](SurfObject& o) { o.type = 21; }), "map of spectra"));
  EXPECT_TRUE(contains(fault([](SurfObject& o) { o.n_objects = 2; }), "ends too early"));
  EXPECT_TRUE(contains(fault([](SurfObject& o) { o.points.pop_back(); }), "only 20 bytes follow"));
  EXPECT_TRUE(contains(fault([](SurfObject& o) {
                         o.compressed = true;
                         o.points.pop_back();
                       }),
                       "hold 20 of 24 bytes"));
  EXPECT_TRUE(contains(fault([](SurfObject& o) { o.spacing_z = 0.0F; }), "scaled by 0"));
}

}  // namespace
}  // namespace manoscope::io
