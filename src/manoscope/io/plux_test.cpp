// .plux archives built by hand after the layout of index.xml in a real one.
#include <gtest/gtest.h>

#include <cmath>

#include "manoscope/io/reader.hpp"
#include "manoscope/io/test_files.hpp"
#include "manoscope/io/test_zip.hpp"

namespace manoscope::io {
namespace {

using testing::complaint;
using testing::contains;
using testing::little;
using testing::refusal;
using testing::stored_zip;
using testing::TestFolder;

std::string index_xml(const std::string& layers) {
  return "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n<xml><Version>1.0</Version><GENERAL>"
         "<DATE>2018-08-24</DATE><FOV_X>0.645</FOV_X><FOV_Y>0.5</FOV_Y><IMAGE_SIZE_X>3</"
         "IMAGE_SIZE_X>"
         "<IMAGE_SIZE_Y>2</IMAGE_SIZE_Y></GENERAL><INFO><SIZE>1</SIZE><ITEM_0><NAME>Objective</"
         "NAME>"
         "<VALUE>EPI 20X  </VALUE></ITEM_0></INFO>" +
         layers + "</xml>";
}

const std::string kLayer =
    "<LAYER_0><POSITION_X>7307.32</POSITION_X><FILENAME_Z>LAYER_0.raw</FILENAME_Z></LAYER_0>";

std::string heights(float first) {
  std::string bytes;
  for (const float value : {first, 2.0F, 3.0F, 4.0F, 1000001.0F, std::nanf("")}) {
    bytes += little(value);
  }
  return bytes;
}

TEST(Plux, ReadsHeightsInMicrometresTopRowFirst) {
  const TestFolder folder;
  const auto channels = read_channels(folder.write(
      "a.plux", stored_zip({{"LAYER_0.raw", heights(1.0F)}, {"index.xml", index_xml(kLayer)}})));
  ASSERT_EQ(channels.size(), 1U);
  const Channel& channel = channels.front();
  EXPECT_EQ(channel.unit, "m");
  EXPECT_DOUBLE_EQ(channel.grid.pitch_x.in(um), 0.645);
  EXPECT_DOUBLE_EQ(channel.grid.pitch_y.in(um), 0.5);
  EXPECT_DOUBLE_EQ(channel.values(0, 0), 1e-6);
  EXPECT_DOUBLE_EQ(channel.values(1, 0), 4e-6);
  EXPECT_TRUE(std::isnan(channel.values(1, 1)));
  EXPECT_TRUE(std::isnan(channel.values(1, 2)));
  bool objective = false;
  for (const auto& [name, value] : channel.settings) {
    objective = objective || (name == "Objective" && value == "EPI 20X");
  }
  EXPECT_TRUE(objective);
}

TEST(Plux, EveryLayerIsAChannel) {
  const TestFolder folder;
  const auto channels = read_channels(folder.write(
      "a.plux",
      stored_zip(
          {{"LAYER_0.raw", heights(1.0F)},
           {"LAYER_1.raw", heights(7.0F)},
           {"index.xml",
            index_xml(kLayer + "<LAYER_1><FILENAME_Z>LAYER_1.raw</FILENAME_Z></LAYER_1>")}})));
  ASSERT_EQ(channels.size(), 2U);
  EXPECT_EQ(channels[1].name, "LAYER_1");
  EXPECT_DOUBLE_EQ(channels[1].values(0, 0), 7e-6);
}

TEST(Plux, WhatDoesNotFitIsRefused) {
  const TestFolder folder;
  const auto fault = [&](const std::vector<std::pair<std::string, std::string>>& files) {
    return refusal(folder, "a.plux", stored_zip(files));
  };
  EXPECT_TRUE(contains(fault({{"index.xml", index_xml(kLayer)}}),
                       "names LAYER_0.raw as the heights, which is not in the archive"));
  EXPECT_TRUE(contains(fault({{"index.xml", index_xml("")}}), "names no layer"));
  EXPECT_TRUE(contains(fault({{"LAYER_0.raw", "123"}, {"index.xml", index_xml(kLayer)}}),
                       "has 3 bytes where 3 x 2 pixels need 24"));
  EXPECT_TRUE(contains(fault({{"LAYER_0.raw", ""}}), "holds no index.xml"));
  EXPECT_TRUE(
      contains(fault({{"index.xml", "<xml><GENERAL/></xml>"}}), "does not give IMAGE_SIZE_X"));
  EXPECT_TRUE(contains(fault({{"index.xml", "<xml><GENERAL>"}}), "not well-formed"));
}

TEST(Plux, TheRealArchiveWithoutHeightsSaysSo) {
  const auto path = testing::shared_data("maps/hx_test.plux");
  if (path.empty()) GTEST_SKIP() << "the folder of real instrument files is absent";
  EXPECT_TRUE(contains(complaint([&] { read_channels(path); }), "which is not in the archive"));
}

TEST(Plux, ThousandsOfLayersOfOneFileAreRefusedBeforeTheyFillTheMemory) {
  const TestFolder folder;
  std::string layers;
  for (int i = 0; i < 100; ++i) layers += kLayer;
  const std::string bytes =
      stored_zip({{"LAYER_0.raw", std::string(24, '\1')}, {"index.xml", index_xml(layers)}});
  EXPECT_TRUE(contains(refusal(folder, "a.plux", bytes), "announces 65 channels"));
}

}  // namespace
}  // namespace manoscope::io
