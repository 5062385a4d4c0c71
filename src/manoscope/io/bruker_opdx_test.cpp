#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "manoscope/io/formats.hpp"
#include "manoscope/io/test_files.hpp"
#include "manoscope/io/test_instrument_files.hpp"

namespace manoscope::io {
namespace {

using testing::BrukerOpdx;
using testing::contains;
using testing::refusal;
using testing::TestFolder;

TEST(BrukerOpdx, ReadsMapsOfEveryKindOfMatrix) {
  const TestFolder folder;
  for (const bool anonymous : {false, true}) {
    for (const bool f64 : {false, true}) {
      BrukerOpdx file;
      file.anonymous_matrix = anonymous;
      file.f64_samples = f64;
      const auto channels = read_channels(folder.write("a.opdx", file.bytes()));
      ASSERT_EQ(channels.size(), 2U);
      const Channel& map = channels.front();
      EXPECT_EQ(map.name, "Raw Height");
      EXPECT_EQ(map.unit, "m");
      ASSERT_EQ(map.grid.nx, 3);
      ASSERT_EQ(map.grid.ny, 2);
      // Extents of 4 um and 1.5 um from first to last centre.
      EXPECT_DOUBLE_EQ(map.grid.pitch_x.in(um), 2.0);
      EXPECT_DOUBLE_EQ(map.grid.pitch_y.in(um), 1.5);
      EXPECT_DOUBLE_EQ(map.values(0, 2), 1.5e-6);
      EXPECT_TRUE(std::isnan(map.values(1, 1)));
      EXPECT_DOUBLE_EQ(map.values(1, 2), 3e-6);
    }
  }
}

TEST(BrukerOpdx, ReadsAProfileAndTheSettings) {
  const TestFolder folder;
  const auto channels = read_channels(folder.write("a.opdx", BrukerOpdx().bytes()));
  const Channel& profile = channels.back();
  EXPECT_EQ(profile.grid.nx, 5);
  EXPECT_EQ(profile.grid.ny, 1);
  EXPECT_DOUBLE_EQ(profile.grid.pitch_x.in(um), 2.0);
  EXPECT_DOUBLE_EQ(profile.values(0, 4), 40e-9);
  const std::vector<std::pair<std::string, std::string>> expected{
      {"Date", "2/11/2021"}, {"StylusForce", "3 mg"}, {"Samples", "3001"}};
  EXPECT_EQ(profile.settings, expected);
}

TEST(BrukerOpdx, ASettingThatIsNoNumberIsLeftOut) {
  const TestFolder folder;
  for (const double force : {std::nan(""), HUGE_VAL}) {
    BrukerOpdx file;
    file.stylus_force = force;
    const auto channels = read_channels(folder.write("a.opdx", file.bytes()));
    const std::vector<std::pair<std::string, std::string>> expected{{"Date", "2/11/2021"},
                                                                    {"Samples", "3001"}};
    EXPECT_EQ(channels.back().settings, expected);
  }
}

TEST(BrukerOpdx, FaultyFilesAreNamed) {
  const TestFolder folder;
  const auto fault = [&](auto&& spoil) {
    BrukerOpdx file;
    spoil(file);
    return refusal(folder, "a.opdx", file.bytes());
  };
  EXPECT_TRUE(contains(fault([](BrukerOpdx& file) { file.nx = 4; }),
                       "a matrix of 4 x 2 samples has 24 bytes"));
  EXPECT_TRUE(
      contains(fault([](BrukerOpdx& file) { file.unit = "furlong/blub"; }), "unknown unit"));
  EXPECT_TRUE(contains(fault([](BrukerOpdx& file) { file.data_scale = std::nan(""); }),
                       "its DataScale is not a number"));
  const std::string empty = std::string("VCA DATA\x01\0\0\x55", 12);
  EXPECT_TRUE(contains(refusal(folder, "b.opdx", empty), "neither a map nor a profile"));
  const std::string whole = BrukerOpdx().bytes();
  EXPECT_TRUE(contains(refusal(folder, "c.opdx", whole.substr(0, whole.size() / 2)), "beyond"));
}

TEST(BrukerOpdx, ARealProfileAgreesWithItsExportAsText) {
  const auto path = testing::shared_data("maps/st_opdx-3.opdx");
  if (path.empty()) GTEST_SKIP() << "no real instrument files here";
  const Channel profile = read_channels(path).front();
  std::istringstream exported(testing::bytes_of(testing::shared_data("maps/st_opdx-3.txt")));
  ASSERT_EQ(profile.grid.nx, 3001);
  double x = 0.0, height = 0.0;
  for (Index i = 0; i < 3001; ++i) {
    ASSERT_TRUE(exported >> x >> height) << i;
    // Eight digits are written.
    EXPECT_NEAR(profile.grid.pitch_x.si() * static_cast<double>(i), x, 1e-7 * x);
    EXPECT_NEAR(profile.values(0, i), height, 1e-7 * std::abs(height));
  }
}

}  // namespace
}  // namespace manoscope::io
