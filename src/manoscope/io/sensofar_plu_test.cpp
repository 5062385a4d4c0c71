#include <gtest/gtest.h>

#include <cmath>

#include "manoscope/io/formats.hpp"
#include "manoscope/io/test_confocal_files.hpp"
#include "manoscope/io/test_files.hpp"

namespace manoscope::io {
namespace {

using testing::complaint;
using testing::contains;
using testing::refusal;
using testing::SensofarPlu;
using testing::TestFolder;

TEST(SensofarPlu, ReadsHeightsInMicrometresFromTheTop) {
  const TestFolder folder;
  const auto channels = read_channels(folder.write("a.plu", SensofarPlu().bytes()));
  ASSERT_EQ(channels.size(), 1U);
  EXPECT_DOUBLE_EQ(channels[0].grid.pitch_x.in(um), 1.5);
  EXPECT_DOUBLE_EQ(channels[0].grid.pitch_y.in(um), 2.5);  // its sign is the file's habit
  EXPECT_DOUBLE_EQ(channels[0].values(0, 2), 3e-6);
  EXPECT_TRUE(std::isnan(channels[0].values(1, 1)));
  EXPECT_EQ(channels[0].settings.front().second, "Fri Mar 10 16:35:59 2023");
}

TEST(SensofarPlu, LayersAreChannelsAndAnOldFileHasOne) {
  const TestFolder folder;
  SensofarPlu file;
  file.n_layers = 3;
  const auto channels = read_channels(folder.write("a.plu", file.bytes()));
  ASSERT_EQ(channels.size(), 3U);
  EXPECT_EQ(channels[2].name, "height 3");
  EXPECT_DOUBLE_EQ(channels[2].values(0, 0), 3e-6);
  file.n_layers = 0;
  EXPECT_EQ(read_channels(folder.write("a.plu", file.bytes())).size(), 1U);
}

TEST(SensofarPlu, AProfileIsOneRowAndNoMap) {
  const TestFolder folder;
  SensofarPlu file;
  file.type = 1;
  file.nx = 6;
  file.ny = 1;
  const auto path = folder.write("a.plu", file.bytes());
  const auto channels = read_channels(path);
  ASSERT_EQ(channels.size(), 1U);
  EXPECT_EQ(channels[0].grid.nx, 6);
  EXPECT_EQ(channels[0].grid.ny, 1);
  EXPECT_DOUBLE_EQ(channels[0].grid.pitch_x.in(um), 1.5);
  EXPECT_DOUBLE_EQ(channels[0].values(0, 3), 4e-6);
  EXPECT_TRUE(std::isnan(channels[0].values(0, 4)));
  EXPECT_TRUE(contains(complaint([&] { read_height_map(path); }), "6 x 1 pixels: a profile"));
  // Several profiles below one another: type 2.
  file.type = 2;
  file.nx = 3;
  file.ny = 2;
  EXPECT_EQ(read_channels(folder.write("b.plu", file.bytes()))[0].grid.ny, 2);
}

TEST(SensofarPlu, OnlyAMapIsRead) {
  const TestFolder folder;
  SensofarPlu file;
  file.type = 4;
  EXPECT_TRUE(contains(refusal(folder, "a.plu", file.bytes()), "a measurement of type 4"));
  file = {};
  file.nx = 30;
  EXPECT_TRUE(contains(
      complaint([&] { sensofar_plu_reader().read(folder.write("a.plu", file.bytes()), {}); }),
      "announces 60 heights"));
  file = {};
  file.date = "no date in 24 characters";
  const auto path = folder.write("b.plu", file.bytes());
  EXPECT_NE(complaint([&] { find_reader(path); }), "");
}

}  // namespace
}  // namespace manoscope::io
