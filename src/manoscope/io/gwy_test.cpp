#include <gtest/gtest.h>

#include <cmath>

#include "manoscope/io/reader.hpp"
#include "manoscope/io/test_files.hpp"
#include "manoscope/io/test_gwy.hpp"

namespace manoscope::io {
namespace {

using testing::complaint;
using testing::contains;
using testing::gwy_component;
using testing::gwy_field;
using testing::gwy_file;
using testing::gwy_object;
using testing::gwy_text;
using testing::little;
using testing::refusal;
using testing::TestFolder;

const std::vector<double> kHeights{1e-6, 2e-6, 3e-6, 4e-6, 5e-6, 6e-6};

TEST(Gwy, ReadsChannelsWithTitlesUnitsMasksAndSettings) {
  const TestFolder folder;
  const std::string other =
      gwy_component(
          "/0/data/log", 'o',
          gwy_object("GwyStringList",
                     gwy_component("strings", 'S', little(2, 4) + gwy_text("a") + gwy_text("b")))) +
      gwy_component("/0/select", 'O', little(1, 4) + gwy_object("Thing", "")) +
      gwy_component("/x", 'b', "\1") + gwy_component("/c", 'C', little(2, 4) + "ab") +
      gwy_component("/i", 'I', little(1, 4) + little(7, 4)) +
      gwy_component("/q", 'Q', little(1, 4) + little(7, 8)) +
      gwy_component("/r", 'q', little(7, 8));
  const auto channels = read_channels(folder.write(
      "a.gwy", gwy_file(other + gwy_component("/0/data", 'o', gwy_field(kHeights, "m")) +
                        gwy_component("/0/data/title", 's', gwy_text("Topography")) +
                        gwy_component("/0/mask", 'o', gwy_field({0, 1, 0, 0, 0, 0.2}, "")) +
                        gwy_component("/0/meta", 'o',
                                      gwy_object("GwyContainer", gwy_component("Objective", 's',
                                                                               gwy_text("20x")))) +
                        gwy_component("/12/data", 'o', gwy_field(kHeights, "V")))));
  ASSERT_EQ(channels.size(), 2U);
  const Channel& height = channels[0];
  EXPECT_EQ(height.name, "Topography");
  EXPECT_EQ(height.unit, "m");
  EXPECT_DOUBLE_EQ(height.grid.pitch_x.si(), 2e-6);
  EXPECT_DOUBLE_EQ(height.grid.pitch_y.si(), 4e-6);
  EXPECT_EQ(height.values(0, 0), 1e-6);
  EXPECT_TRUE(std::isnan(height.values(0, 1)));  // masked
  EXPECT_EQ(height.values(1, 2), 6e-6);          // its mask is below a half
  bool objective = false, offset = false;
  for (const auto& [name, value] : height.settings) {
    objective = objective || (name == "Objective" && value == "20x");
    offset = offset || (name == "offset x" && value == "1e-06 m");
  }
  EXPECT_TRUE(objective && offset);
  EXPECT_EQ(channels[1].unit, "V");
}

TEST(Gwy, PositionsWithoutAUnitNeedOne) {
  const TestFolder folder;
  const auto path =
      folder.write("a.gwy", gwy_file(gwy_component("/0/data", 'o', gwy_field(kHeights, "m", ""))));
  EXPECT_TRUE(contains(complaint([&] { read_height_map(path); }), "--lateral-unit"));
  ReadOptions options;
  options.lateral_unit = "km";
  EXPECT_DOUBLE_EQ(read_height_map(path, options).grid().pitch_x.si(), 2e-3);
  options.lateral_unit = "kPa";
  EXPECT_TRUE(contains(complaint([&] { read_height_map(path, options); }), "not a unit of length"));
}

TEST(Gwy, WhatDoesNotFitIsRefused) {
  const TestFolder folder;
  const auto fault = [&](const std::string& bytes) { return refusal(folder, "a.gwy", bytes); };
  const std::string good = gwy_file(gwy_component("/0/data", 'o', gwy_field(kHeights, "m")));
  EXPECT_EQ(fault(good), "");
  for (std::size_t length = 4; length < good.size(); ++length) {
    EXPECT_FALSE(fault(good.substr(0, length)).empty()) << length;
  }
  EXPECT_TRUE(contains(fault("GWYO" + good.substr(4)), "Gwyddion 1"));
  EXPECT_TRUE(contains(fault(gwy_file("")), "holds no image channel"));
  EXPECT_TRUE(contains(fault("GWYP" + gwy_object("GwyBrick", "")), "holds a GwyBrick"));
  EXPECT_TRUE(contains(fault(gwy_file(gwy_component("a", 'z', little(0, 4)))), "unknown type 122"));
  std::string field = gwy_field(kHeights, "m");
  field.replace(field.find("xres") + 6, 4, little(4, 4));
  EXPECT_TRUE(contains(fault(gwy_file(gwy_component("/0/data", 'o', field))),
                       "4 x 2 pixels are announced, 6 are there"));
  EXPECT_TRUE(contains(fault(gwy_file(gwy_component("/0/data", 'o', gwy_field(kHeights, "m")) +
                                      gwy_component("/0/mask", 'o', gwy_field({0, 0, 0}, "")))),
                       "its mask has 3 x 1 pixels"));
  // An object that claims more than its parent has.
  std::string longer = good;
  longer.replace(longer.find("GwyDataField") + 13, 4, little(field.size() + 1000, 4));
  EXPECT_FALSE(fault(longer).empty());
}

}  // namespace
}  // namespace manoscope::io
