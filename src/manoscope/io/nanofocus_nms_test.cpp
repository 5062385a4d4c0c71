#include <gtest/gtest.h>

#include <cmath>

#include "manoscope/io/formats.hpp"
#include "manoscope/io/test_confocal_files.hpp"
#include "manoscope/io/test_files.hpp"

namespace manoscope::io {
namespace {

using testing::contains;
using testing::NanoFocusNms;
using testing::refusal;
using testing::TestFolder;

TEST(NanoFocusNms, ReadsHeightsBetweenTheLimitsAndDarkPixelsAsMissing) {
  const TestFolder folder;
  const auto channels = read_channels(folder.write("a.nms", NanoFocusNms().bytes()));
  ASSERT_EQ(channels.size(), 2U);
  const Channel& height = channels.front();
  EXPECT_DOUBLE_EQ(height.grid.pitch_x.in(um), 1.5);
  EXPECT_DOUBLE_EQ(height.grid.pitch_y.in(um), 2.5);
  EXPECT_DOUBLE_EQ(height.values(0, 0), -1e-6);
  EXPECT_NEAR(height.values(0, 2), 0.0, 1e-21);  // round-off of the sum of two micrometres
  EXPECT_NEAR(height.values(1, 1), 1e-6, 1e-21);
  EXPECT_TRUE(std::isnan(height.values(1, 2)));  // no light came back
  EXPECT_EQ(channels[1].values(1, 1), 80.0);
}

TEST(NanoFocusNms, WithoutReflectionEveryPixelCounts) {
  const TestFolder folder;
  NanoFocusNms file;
  file.with_reflection = false;
  const auto channels = read_channels(folder.write("a.nms", file.bytes()));
  ASSERT_EQ(channels.size(), 1U);
  EXPECT_EQ(channels[0].values.isNaN().count(), 0);
}

TEST(NanoFocusNms, ARangeThatIsNoneIsRefused) {
  const TestFolder folder;
  NanoFocusNms file;
  file.most = file.least;
  EXPECT_TRUE(contains(refusal(folder, "a.nms", file.bytes()), "the range of its heights is none"));
}

TEST(NanoFocusNms, ARealFileHasItsPixelSize) {
  const auto path = testing::shared_data("maps/st_nms-1.nms");
  if (path.empty()) GTEST_SKIP() << "no real instrument files here";
  const auto channels = read_channels(path);
  EXPECT_NEAR(channels[0].grid.pitch_x.in(um), 0.3125, 1e-7);  // as another reader has it
  EXPECT_EQ(channels[0].values.isNaN().count(), 0);
}

}  // namespace
}  // namespace manoscope::io
