// Text that lists points: tables, profiles, Zygo's .xyz and Wyko's columns.
#include <gtest/gtest.h>

#include <cmath>

#include "manoscope/io/reader.hpp"
#include "manoscope/io/test_files.hpp"
#include "manoscope/io/test_text.hpp"
#include "manoscope/io/text_cells.hpp"
#include "manoscope/io/text_table.hpp"

namespace manoscope::io {
namespace {

using testing::complaint;
using testing::contains;
using testing::refusal;
using testing::TestFolder;
using testing::wyko_text;
using testing::zygo_text;

/// The text as UTF-16 with a byte order mark; ASCII and the micro sign only.
std::string utf16(const std::string& text, bool little) {
  std::string bytes = little ? "\xFF\xFE" : "\xFE\xFF";
  for (const char letter : text) {
    bytes += little ? std::string{letter, '\0'} : std::string{'\0', letter};
  }
  return bytes;
}

TEST(TextTable, UnitsStandInTheNamesOfColumns) {
  EXPECT_EQ(unit_of_label("X_(microns)"), "microns");
  EXPECT_EQ(unit_of_label("x in \xC2\xB5m"), "\xC2\xB5m");
  EXPECT_EQ(unit_of_label("Height [nm]"), "nm");
  EXPECT_EQ(unit_of_label("Lateral um"), "um");
  EXPECT_EQ(unit_of_label("y1"), "");
  EXPECT_EQ(unit_of_label("Height (raw)"), "");
  EXPECT_EQ(unit_of_label(""), "");
}

TEST(TextTable, TriplesOnAGridAreAMapWithTheSmallestYOnTop) {
  const TestFolder folder;
  for (const std::string labels : {"x [um],y [um],Height [nm]\n", "x (um),y (um),Height (nm)\n"}) {
    const HeightMap map = read_height_map(
        folder.write("a.csv", labels + "0,10,4\n2,10,5\n4,10,Bad\n0,5,1\n2,5,2\n4,5,3\n"));
    EXPECT_EQ(map.grid().nx, 3);
    EXPECT_EQ(map.grid().ny, 2);
    EXPECT_DOUBLE_EQ(map.grid().pitch_x.in(um), 2.0);
    EXPECT_DOUBLE_EQ(map.grid().pitch_y.in(um), 5.0);
    EXPECT_DOUBLE_EQ(map.height()(0, 2), 3e-9);
    EXPECT_DOUBLE_EQ(map.height()(1, 0), 4e-9);
    EXPECT_NE(map.flags()(1, 2), 0);
  }
}

TEST(TextTable, PositionsWithoutUnitTakeTheUsers) {
  const TestFolder folder;
  const auto path = folder.write("a.xyz", "0 0 1\n0 1 2\n1 0 3\n1 1 4\n");
  ReadOptions options;
  options.height_unit = "nm";
  EXPECT_TRUE(contains(complaint([&] { read_height_map(path, options); }), "--lateral-unit"));
  options.lateral_unit = "mm";
  EXPECT_DOUBLE_EQ(read_height_map(path, options).grid().pitch_y.in(mm), 1.0);
  EXPECT_DOUBLE_EQ(read_height_map(path, options).height()(1, 0), 2e-9);  // x = 0, y = 1
}

TEST(TextTable, ProfilesAreReadInUtf16AndWithACountingColumn) {
  const TestFolder folder;
  for (const bool little : {true, false}) {
    const Channel channel =
        read_channels(folder.write("a.csv", utf16(",x in um,y in um\r\n0,-1,5\r\n1,-0.5,6\r\n"
                                                  "2,0,7\r\n3,0.5,8\r\n",
                                                  little)))
            .front();
    EXPECT_EQ(channel.grid.nx, 4);
    EXPECT_EQ(channel.grid.ny, 1);
    EXPECT_DOUBLE_EQ(channel.grid.pitch_x.in(um), 0.5);
    EXPECT_DOUBLE_EQ(channel.values(0, 3), 8e-6);
    EXPECT_EQ(channel.unit, "m");
  }
  EXPECT_EQ(utf8_text(std::string("\xFF\xFE\xB5\x00\x3D\xD8\x00\xDE", 8)),
            "\xC2\xB5\xF0\x9F\x98\x80");
  EXPECT_EQ(utf8_text(std::string("\xFF\xFE\x00\xD8", 4)), "\xEF\xBF\xBD");  // half a pair
  EXPECT_EQ(utf8_text("plain"), "plain");
}

TEST(TextTable, RealProfilesAreReadToTheirNumbers) {
  if (testing::shared_data("maps").empty()) GTEST_SKIP() << "no samples of other programs here";
  const auto profile = [](const char* name) {
    return read_channels(testing::shared_data(std::string("maps/") + name)).front();
  };
  const Channel microns = profile("st_csv-1.csv");
  EXPECT_EQ(microns.grid.ny, 1);
  EXPECT_EQ(microns.name, "y1");
  EXPECT_EQ(microns.unit, "");
  EXPECT_NEAR(microns.grid.pitch_x.in(um), (0.3089 - 0.0386) / 7, 1e-12);
  EXPECT_EQ(microns.values(0, 0), 2.10425);
  for (const char* name : {"st_csv-2.csv", "st_csv-3.csv"}) {
    const Channel channel = profile(name);
    EXPECT_NEAR(channel.grid.pitch_x.in(um), 1.0 / 12.0, 1e-9) << name;
    EXPECT_NEAR(channel.values(0, 0), -1.4274328574349e-6, 1e-18) << name;
    EXPECT_EQ(channel.unit, "m");
  }
  const Channel bruker = profile("st_opdx-3.txt");
  EXPECT_EQ(bruker.grid.ny, 1);
  EXPECT_EQ(bruker.values(0, 0), 1.3718306e-09);
}

TEST(ZygoXyz, ReadsTheWindowItsPlaceAndNoData) {
  const TestFolder folder;
  const Channel channel = read_channels(folder.write("a.xyz", zygo_text())).front();
  EXPECT_EQ(channel.grid.nx, 3);
  EXPECT_EQ(channel.grid.ny, 2);
  EXPECT_EQ(channel.offset_x, 10);
  EXPECT_EQ(channel.offset_y, 20);
  EXPECT_DOUBLE_EQ(channel.grid.pitch_x.si(), 5.067e-5);
  EXPECT_EQ(channel.unit, "m");
  EXPECT_TRUE(std::isnan(channel.values(0, 0)));
  EXPECT_DOUBLE_EQ(channel.values(0, 1), 2e-6);
  EXPECT_DOUBLE_EQ(channel.values(1, 2), -6.5e-6);
  EXPECT_TRUE(channel.warnings.empty());
}

TEST(ZygoXyz, WhatDoesNotFitIsRefused) {
  const TestFolder folder;
  const auto fault = [&](const std::string& from, const std::string& to) {
    std::string text = zygo_text();
    text.replace(text.find(from), from.size(), to);
    return refusal(folder, "a.xyz", text);
  };
  EXPECT_TRUE(contains(fault("10 20 3 2", "10 20 3000 2000"), "announces 3000 x 2000 pixels in"));
  EXPECT_TRUE(contains(fault("10 20 3 2", "10 20 3 1"), "a.xyz:18 | more than 3 pixels follow"));
  EXPECT_TRUE(contains(fault("12 21 -6.5", "13 21 -6.5"), "outside the window"));
  EXPECT_TRUE(contains(fault("12 21 -6.5", "12 21 x"), "\"x\" is not a number"));
  EXPECT_TRUE(contains(fault("-6.5\n#", "-6.5\n"), "no # ends its heights"));
}

TEST(WykoAscii, ColumnsRunFromBottomToTop) {
  const TestFolder folder;
  for (const int in_nm : {0, 1}) {
    const Channel channel = read_channels(folder.write("a.asc", wyko_text(in_nm))).front();
    EXPECT_EQ(channel.grid.nx, 4);
    EXPECT_EQ(channel.grid.ny, 3);
    EXPECT_DOUBLE_EQ(channel.grid.pitch_x.in(um), 2.0);
    EXPECT_DOUBLE_EQ(channel.grid.pitch_y.in(um), 2.5);
    const double scale = in_nm != 0 ? 1e-9 : 632.8e-9 / 2.0;
    EXPECT_DOUBLE_EQ(channel.values(2, 0), 1 * scale);  // first of its column: the bottom
    EXPECT_DOUBLE_EQ(channel.values(0, 0), 3 * scale);
    EXPECT_TRUE(std::isnan(channel.values(1, 1)));
    EXPECT_DOUBLE_EQ(channel.values(0, 3), 12 * scale);
  }
}

TEST(WykoAscii, WhatDoesNotFitIsRefused) {
  const TestFolder folder;
  const auto fault = [&](const std::string& from, const std::string& to) {
    std::string text = wyko_text(1);
    text.replace(text.find(from), from.size(), to);
    return refusal(folder, "a.asc", text);
  };
  EXPECT_TRUE(contains(fault("X Size\t4", "X Size\t4000"), "announces 4000 x 3 pixels"));
  EXPECT_TRUE(contains(fault("X Size\t4", "X Size\t5"), "ends after 4 of 5 columns"));
  EXPECT_TRUE(contains(fault("X Size\t4", "X Size\t0"), "announces 0 x 3 pixels"));
  EXPECT_TRUE(contains(fault("7\t8\t9", "7\t8"), "is where height 3 of 3 should be"));
  EXPECT_TRUE(contains(fault("7\t8\t9", "7\t8\t9\t10"), "has more than 3 heights"));
  EXPECT_TRUE(contains(fault("RAW_DATA", "raw_data"), "holds no block of heights"));
}

}  // namespace
}  // namespace manoscope::io
