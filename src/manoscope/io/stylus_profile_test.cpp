#include <gtest/gtest.h>

#include <cmath>

#include "manoscope/io/formats.hpp"
#include "manoscope/io/test_files.hpp"

namespace manoscope::io {
namespace {

using testing::complaint;
using testing::contains;
using testing::refusal;
using testing::TestFolder;

const std::string kDektakHead =
    "Scan Parameters\r\nStylus,Radius: 2.5 \xb5m\r\n\r\nScan Data\r\n\r\nLateral um,Raw Micrometer,"
    "\r\n";

TEST(StylusProfile, ReadsDektakPointsWithRoundedPositions) {
  const TestFolder folder;
  const auto path =
      folder.write("a.csv", kDektakHead + "0.0,1.5,,\r\n0.2,1.25,,\r\n0.3,-1,,\r\n0.5,2e1,,\r\n");
  const auto channels = read_channels(path);
  ASSERT_EQ(channels.size(), 1U);
  EXPECT_EQ(channels[0].grid.nx, 4);
  EXPECT_EQ(channels[0].grid.ny, 1);
  EXPECT_NEAR(channels[0].grid.pitch_x.in(um), 0.5 / 3.0, 1e-15);
  EXPECT_DOUBLE_EQ(channels[0].values(0, 3), 20e-6);
  EXPECT_EQ(channels[0].settings.front().second, "Radius: 2.5 \xc2\xb5m");
  EXPECT_TRUE(contains(complaint([&] { read_height_map(path); }), "a profile, not a map"));
}

TEST(StylusProfile, HfmPointsThatAreNotValidAreMissing) {
  const TestFolder folder;
  const auto channels = read_channels(
      folder.write("a.hfm", "X;Y;valid\n[mm];[um];[1/0]\n1.0;5.5;1\n1.5;6.5;0\n2.0;7.5;1\n"));
  EXPECT_DOUBLE_EQ(channels[0].grid.pitch_x.si(), 0.5e-3);
  EXPECT_DOUBLE_EQ(channels[0].values(0, 0), 5.5e-6);
  EXPECT_TRUE(std::isnan(channels[0].values(0, 1)));
}

TEST(StylusProfile, FaultyProfilesAreNamed) {
  const TestFolder folder;
  const auto fault = [&](const std::string& text) { return refusal(folder, "a.hfm", text); };
  const std::string head = "X;Y;valid\n[mm];[um];[1/0]\n";
  EXPECT_TRUE(contains(fault(head + "1;1;1\n2;1;1\n4.5;1;1\n"), "not evenly spaced: number 2"));
  EXPECT_TRUE(contains(fault(head + "1;1;1\nx;1;1\n"), "a.hfm:4 | \"x;1;1\" is not a position"));
  EXPECT_TRUE(contains(fault(head + "1;1;1\n"), "holds 1 points"));
  EXPECT_TRUE(contains(fault("X;Y;valid\n[mm];[V];[1/0]\n1;1;1\n"), "\"V\" is no unit of length"));
  EXPECT_TRUE(contains(fault("X;Y;valid"), "ends after its first line"));
}

TEST(StylusProfile, ReadsRealProfilesWhole) {
  if (testing::shared_data("maps").empty()) GTEST_SKIP() << "no real instrument files here";
  // Counted and looked up in the text: 9600 points each, first and last.
  const Channel dektak = read_channels(testing::shared_data("maps/st_dektak-1.csv")).front();
  EXPECT_EQ(dektak.grid.nx, 9600);
  EXPECT_NEAR(dektak.grid.pitch_x.in(um), 0.156, 5e-4);  // "Resolution,0.156 um/sample"
  EXPECT_DOUBLE_EQ(dektak.values(0, 9599), 16.58112e-6);
  const Channel hfm = read_channels(testing::shared_data("maps/st_hfm-1.hfm")).front();
  EXPECT_EQ(hfm.grid.nx, 9600);
  EXPECT_NEAR(hfm.grid.pitch_x.in(um), 0.5, 1e-6);
  EXPECT_DOUBLE_EQ(hfm.values(0, 0), 106.606853e-3);
}

}  // namespace
}  // namespace manoscope::io
