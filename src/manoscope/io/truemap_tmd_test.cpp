#include <gtest/gtest.h>

#include "manoscope/io/formats.hpp"
#include "manoscope/io/test_confocal_files.hpp"
#include "manoscope/io/test_files.hpp"

namespace manoscope::io {
namespace {

using testing::contains;
using testing::refusal;
using testing::TestFolder;
using testing::TrueMapTmd;

TEST(TrueMapTmd, ReadsMillimetresWhateverTheLengthOfTheComment) {
  const TestFolder folder;
  for (const std::string comment :
       {"", "Created by TrueMap v6\r\n", "a longer comment than most"}) {
    TrueMapTmd file;
    file.comment = comment;
    const auto channels = read_channels(folder.write("a.tmd", file.bytes()));
    EXPECT_DOUBLE_EQ(channels[0].grid.pitch_x.si(), 2e-3);
    EXPECT_DOUBLE_EQ(channels[0].grid.pitch_y.si(), 4e-3);
    EXPECT_EQ(channels[0].unit, "m");
    EXPECT_DOUBLE_EQ(channels[0].values(1, 0), 4e-3);
  }
}

TEST(TrueMapTmd, FaultyFilesAreNamed) {
  const TestFolder folder;
  TrueMapTmd file;
  file.tail = "1234";
  EXPECT_TRUE(contains(refusal(folder, "a.tmd", file.bytes()),
                       "4 bytes follow the heights of 3 x 2 pixels"));
  file = {};
  file.size_x = -1.0F;
  EXPECT_TRUE(contains(refusal(folder, "a.tmd", file.bytes()), "gives a pixel of"));
}

TEST(TrueMapTmd, ARealFileHasItsPixelSize) {
  const auto path = testing::shared_data("maps/st_tmd-1.tmd");
  if (path.empty()) GTEST_SKIP() << "no real instrument files here";
  const auto channels = read_channels(path);
  // 0.0631887 in the file's unit, as another reader prints it.
  EXPECT_NEAR(channels[0].grid.pitch_x.in(mm), 0.0631887, 5e-8);
}

}  // namespace
}  // namespace manoscope::io
