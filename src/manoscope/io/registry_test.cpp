#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

#include "manoscope/core/flags.hpp"
#include "manoscope/io/map_summary.hpp"
#include "manoscope/io/reader.hpp"
#include "manoscope/io/test_classic_netcdf.hpp"
#include "manoscope/io/test_files.hpp"
#include "manoscope/io/writer.hpp"

namespace manoscope::io {
namespace {

using testing::complaint;
using testing::contains;
using testing::TestFolder;

HeightMap tilted_map() {
  Array2 height(3, 4);
  for (Index i = 0; i < height.size(); ++i) height.data()[i] = 1e-6 * static_cast<double>(i);
  Flags2 flags = Flags2::Zero(3, 4);
  flags(2, 3) = PixelFlag::no_data;
  return HeightMap(CameraGrid{4, 3, 2.0 * um, 5.0 * um}, height, flags);
}

/// Two length channels over one pair of axes without coordinates.
std::string two_heights() {
  testing::ClassicNetcdf file;
  file.dimensions = {{"y", 2}, {"x", 2}};
  const std::string data = testing::ClassicNetcdf::doubles({1, 2, 3, 4});
  file.variables = {{"before", {0, 1}, {{"units", "nm"}}, {}, data},
                    {"after", {0, 1}, {{"units", "um"}}, {}, data},
                    {"current", {0, 1}, {{"units", "mA"}}, {}, data},
                    {"raw", {0, 1}, {}, {}, data}};
  return file.bytes(1);
}

TEST(Registry, EveryReaderHasAShortUniqueNameAndExtensions) {
  std::set<std::string_view> names;
  for (const Reader* reader : readers()) {
    EXPECT_TRUE(names.insert(reader->name()).second) << reader->name();
    EXPECT_FALSE(reader->description().empty());
    ASSERT_FALSE(reader->extensions().empty());
    for (const std::string& extension : reader->extensions()) EXPECT_EQ(extension.front(), '.');
  }
  EXPECT_GE(names.size(), 3U);
}

TEST(Registry, ContentCountsNotTheName) {
  const TestFolder folder;
  write_gsf(folder / "a.gsf", tilted_map(), "t");
  write_netcdf_map(folder / "a.nc", tilted_map(), "t");
  write_text_map(folder / "a.txt", tilted_map(), "t");
  for (const auto& [name, format] :
       {std::pair{"a.gsf", "gsf"}, std::pair{"a.nc", "netcdf"}, std::pair{"a.txt", "text"}}) {
    EXPECT_EQ(find_reader(folder / name).name(), format);
    const auto renamed = folder.write("map.bin", testing::bytes_of(folder / name));
    EXPECT_EQ(find_reader(renamed).name(), format);
  }
}

TEST(Registry, UnknownFilesAreAnsweredWithTheListOfFormats) {
  const TestFolder folder;
  const std::string text = complaint(
      [&] { find_reader(folder.write("a.xyz", std::string("\x89PNG\r\n\x1a\n\0\0", 10))); });
  for (const Reader* reader : readers()) {
    EXPECT_TRUE(contains(text, std::string(reader->description())));
    EXPECT_TRUE(contains(text, reader->extensions().front()));
  }
}

TEST(Registry, MissingEmptyAndUnreadableFilesAreNamed) {
  const TestFolder folder;
  EXPECT_TRUE(contains(complaint([&] { read_height_map(folder / "absent.gsf"); }), "absent.gsf"));
  EXPECT_TRUE(contains(complaint([&] { read_height_map(folder.write("a.gsf", "")); }), "is empty"));
  EXPECT_THROW(read_height_map(folder.path()), InputError);
  EXPECT_THROW(read_height_map("/dev/null"), InputError);
}

TEST(ReadHeightMap, ChoosesAmongChannelsOnlyWhenToldOrForced) {
  const TestFolder folder;
  const auto path = folder.write("a.nc", two_heights());
  ReadOptions options;
  options.pitch_x = options.pitch_y = 1.0 * um;
  const auto read = [&] { return read_height_map(path, options).height()(0, 1); };
  EXPECT_TRUE(contains(complaint(read), "--channel"));
  EXPECT_TRUE(contains(complaint(read),
                       "#1 \"before\" 2 x 2 [m], #2 \"after\" 2 x 2 [m], "
                       "#3 \"current\" 2 x 2 [A], #4 \"raw\" 2 x 2 [?]"));
  options.channel = "after";
  EXPECT_NEAR(read(), 2e-6, 1e-20);
  options.channel = "current";
  EXPECT_TRUE(contains(complaint(read), "has no heights"));
  options.channel = "raw";
  EXPECT_TRUE(contains(complaint(read), "--height-unit nm"));
  options.height_unit = "nm";
  EXPECT_NEAR(read(), 2e-9, 1e-23);
  options.channel = "befor";
  EXPECT_TRUE(contains(complaint(read), "did you mean \"before\"?"));
}

TEST(ReadHeightMap, AUnitThatIsNoLengthIsRefused) {
  const TestFolder folder;
  const auto path = folder.write("a.csv", "1,2\n3,4\n");
  for (const char* unit : {"kPa", "blub", "3", "1/m"}) {
    ReadOptions options;
    options.height_unit = unit;
    EXPECT_TRUE(contains(complaint([&] { read_height_map(path, options); }), "--height-unit"))
        << unit;
  }
}

TEST(ReadHeightMap, AContradictionBetweenFileAndUserIsNotSettledInSilence) {
  const TestFolder folder;
  write_gsf(folder / "a.gsf", tilted_map(), "t");
  ReadOptions options;
  options.pitch_x = 2.0 * um;  // what the file says too
  EXPECT_NO_THROW(read_height_map(folder / "a.gsf", options));
  options.pitch_x = 2.1 * um;
  EXPECT_TRUE(contains(complaint([&] { read_height_map(folder / "a.gsf", options); }),
                       "says itself that its pitch in x is 2 um, not 2.1 um"));
  options.pitch_x = -2.0 * um;
  EXPECT_TRUE(
      contains(complaint([&] { read_height_map(folder / "a.gsf", options); }), "--pitch-x"));
  options.pitch_x = std::nullopt;
  options.height_unit = "m";
  EXPECT_NO_THROW(read_height_map(folder / "a.gsf", options));
  options.height_unit = "nm";
  EXPECT_TRUE(
      contains(complaint([&] { read_height_map(folder / "a.gsf", options); }), "says itself"));
}

TEST(ReadHeightMap, MapsWithoutContentAreRefused) {
  const TestFolder folder;
  const std::string header = "# pixel size: 1 um\n# unit: nm\n";
  EXPECT_TRUE(contains(
      complaint([&] { read_height_map(folder.write("a.txt", header + "1 nan\nnan nan\n")); }), ""));
  write_gsf(folder / "nan.gsf",
            HeightMap(CameraGrid{2, 2, 1.0 * um, 1.0 * um},
                      Array2::Constant(2, 2, std::numeric_limits<double>::quiet_NaN())),
            "");
  EXPECT_TRUE(contains(complaint([&] { read_height_map(folder / "nan.gsf"); }),
                       "none of its 4 pixels holds a height"));
  EXPECT_TRUE(
      contains(complaint([&] { read_height_map(folder.write("b.txt", header + "1 2 3 4\n")); }),
               "has 4 x 1 pixels: a profile, not a map"));
}

TEST(WriteMap, FollowsTheExtension) {
  const TestFolder folder;
  for (const auto& [name, format] : {std::pair{"a.GSF", "gsf"}, std::pair{"b.nc", "netcdf"},
                                     std::pair{"c.csv", "text"}, std::pair{"d.txt", "text"}}) {
    write_map(folder / name, tilted_map(), "t");
    EXPECT_EQ(find_reader(folder / name).name(), format);
  }
  EXPECT_TRUE(contains(complaint([&] { write_map(folder / "e.bmp", tilted_map(), "t"); }), ".bmp"));
  EXPECT_THROW(write_map(folder / "e", tilted_map(), "t"), InputError);
}

TEST(MapSummary, TellsSizesScaleAndStatistics) {
  const TestFolder folder;
  write_text_map(folder / "a.txt", tilted_map(), "tilted");
  const MapSummary summary = summarise_map(folder / "a.txt");
  EXPECT_EQ(summary.file, folder / "a.txt");
  EXPECT_EQ(summary.format, "text");
  ASSERT_EQ(summary.channels.size(), 1U);
  const ChannelSummary& channel = summary.channels.front();
  EXPECT_EQ(channel.name, "tilted");
  EXPECT_EQ(channel.nx, 4);
  EXPECT_EQ(channel.ny, 3);
  EXPECT_DOUBLE_EQ(channel.pitch_x_m.value(), 2e-6);
  EXPECT_DOUBLE_EQ(channel.size_y_m.value(), 15e-6);
  EXPECT_EQ(channel.unit, "m");
  EXPECT_EQ(channel.missing, 1);
  // Of 0 ... 10 um: mean 5 um, variance (11^2 - 1) / 12 = 10 um^2.
  EXPECT_DOUBLE_EQ(channel.min.value(), 0.0);
  EXPECT_DOUBLE_EQ(channel.max.value(), 10e-6);
  EXPECT_NEAR(channel.mean.value(), 5e-6, 1e-20);
  EXPECT_NEAR(channel.rms.value(), std::sqrt(10.0) * 1e-6, 1e-20);
}

TEST(MapSummary, KeepsTheRmsOfAMapFarFromZero) {
  Channel channel;
  channel.grid = CameraGrid{500, 400, 1.0 * um, 1.0 * um};
  channel.values.resize(400, 500);
  for (Index i = 0; i < channel.values.size(); ++i) {
    channel.values.data()[i] = 1.0 + (i % 2 == 0 ? 1e-9 : -1e-9);
  }
  // A double near 1 resolves 2e-16, so 1e-9 is known to 2e-7 of itself.
  EXPECT_NEAR(summarise(channel).rms.value(), 1e-9, 4e-16);
}

TEST(MapSummary, WhatIsUnknownIsAbsent) {
  const TestFolder folder;
  const ChannelSummary channel =
      summarise_map(folder.write("a.csv", "1,2,3,4\n5,6,7,8\n")).channels.front();
  EXPECT_FALSE(channel.pitch_x_m || channel.size_x_m || channel.pitch_y_m || channel.size_y_m);
  EXPECT_EQ(channel.unit, "");
  EXPECT_EQ(channel.mean, 4.5);
  Channel empty;
  empty.grid = CameraGrid{2, 2, Length{}, Length{}};
  empty.values = Array2::Constant(2, 2, std::numeric_limits<double>::quiet_NaN());
  EXPECT_FALSE(summarise(empty).min || summarise(empty).mean || summarise(empty).rms);
  EXPECT_EQ(summarise(empty).missing, 4);
}

}  // namespace
}  // namespace manoscope::io
