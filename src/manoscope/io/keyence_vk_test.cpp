#include <gtest/gtest.h>

#include "manoscope/io/formats.hpp"
#include "manoscope/io/test_confocal_files.hpp"
#include "manoscope/io/test_files.hpp"
#include "manoscope/io/test_zip.hpp"

namespace manoscope::io {
namespace {

using testing::contains;
using testing::KeyenceVk4;
using testing::refusal;
using testing::stored_zip;
using testing::TestFolder;

void expect_the_map(const std::vector<Channel>& channels) {
  ASSERT_EQ(channels.size(), 2U);
  EXPECT_EQ(channels[0].name, "height");
  EXPECT_EQ(channels[0].unit, "m");
  EXPECT_DOUBLE_EQ(channels[0].grid.pitch_x.in(um), 1.38);
  EXPECT_DOUBLE_EQ(channels[0].grid.pitch_y.in(um), 1.39);
  ASSERT_EQ(channels[0].grid.nx, 3);
  ASSERT_EQ(channels[0].grid.ny, 2);
  EXPECT_DOUBLE_EQ(channels[0].values(0, 0), 10 * 100e-12);
  EXPECT_DOUBLE_EQ(channels[0].values(1, 0), 13 * 100e-12);
  EXPECT_EQ(channels[1].name, "light");
  EXPECT_EQ(channels[1].values(1, 2), 15.0);
  EXPECT_EQ(channels[0].settings.front().second, "2015-07-08 09:10:11");
}

TEST(KeyenceVk, ReadsHeightsInPicometresOfEveryWidth) {
  const TestFolder folder;
  for (const int bits : {8, 16, 32}) {
    KeyenceVk4 file;
    file.height_bits = bits;
    expect_the_map(read_channels(folder.write("a.vk4", file.bytes())));
  }
}

TEST(KeyenceVk, ReadsTheVk4FileInsideALaterOne) {
  const TestFolder folder;
  const std::string archive =
      stored_zip({{"Readme", "PK is not the beginning"}, {"Vk4File", KeyenceVk4().bytes()}});
  expect_the_map(read_channels(folder.write("a.vk6", "VK6" + std::string(29, '\7') + archive)));
  expect_the_map(read_channels(folder.write("a.vk7", "VK7" + std::string(4, '\0') + archive)));
}

TEST(KeyenceVk, AVk3LaidOutAsAVk4IsReadAndOneWithAShorterTableRefused) {
  const TestFolder folder;
  KeyenceVk4 file;
  file.magic = "VK3_";
  const auto path = folder.write("a.vk3", file.bytes());
  EXPECT_EQ(find_reader(path).name(), "keyence-vk");
  expect_the_map(read_channels(path));
  file.n_offsets = 14;
  EXPECT_TRUE(contains(refusal(folder, "b.vk3", file.bytes()),
                       "begin at byte 68, inside what is the table of offsets"));
}

TEST(KeyenceVk, FaultyFilesAreNamed) {
  const TestFolder folder;
  const auto fault = [&](auto&& spoil) {
    KeyenceVk4 file;
    spoil(file);
    return refusal(folder, "a.vk4", file.bytes());
  };
  EXPECT_TRUE(contains(fault([](KeyenceVk4& f) { f.height_bits = 24; }), "pixels of 24 bits"));
  EXPECT_TRUE(contains(fault([](KeyenceVk4& f) { f.compression = 1; }), "compressed by method 1"));
  EXPECT_TRUE(contains(fault([](KeyenceVk4& f) { f.nx = 3000; }), "announces 6000 pixels"));
  EXPECT_TRUE(contains(fault([](KeyenceVk4& f) { f.with_images = false; }), "holds no image"));
  EXPECT_TRUE(contains(refusal(folder, "b.vk6", "VK6nothing"), "holds no zip archive"));
  const std::string other = "VK6" + stored_zip({{"Other", "x"}});
  EXPECT_TRUE(contains(refusal(folder, "c.vk6", other), "no file Vk4File"));
  const std::string nested = "VK6" + stored_zip({{"Vk4File", other}});
  EXPECT_TRUE(contains(refusal(folder, "d.vk6", nested), "does not begin with VK4_"));
}

}  // namespace
}  // namespace manoscope::io
