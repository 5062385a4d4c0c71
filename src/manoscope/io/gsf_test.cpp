#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "manoscope/core/flags.hpp"
#include "manoscope/io/formats.hpp"
#include "manoscope/io/test_files.hpp"
#include "manoscope/io/writer.hpp"

namespace manoscope::io {
namespace {

using testing::contains;
using testing::little;
using testing::refusal;
using testing::TestFolder;

/// A file laid out by hand from the format's description.
std::string gsf(const std::string& header, const std::string& data) {
  std::string bytes = "Gwyddion Simple Field 1.0\n" + header;
  do bytes += '\0';
  while (bytes.size() % 4 != 0);
  return bytes + data;
}

std::string six_heights() {
  return little(1.0F) + little(2.0F) + little(3.0F) + little(4.0F) + little(5.0F) + little(6.0F);
}

TEST(Gsf, ReadsAFileBuiltByHandTopRowFirst) {
  const TestFolder folder;
  const auto path = folder.write(
      "a.gsf", gsf("XRes = 3\nYRes=2\n  XReal =  6e-3\nYReal = 8e-3  \nXYUnits = m\nZUnits = um\n"
                   "Title = My map = nice\nXOffset = -1\nSoftware = x\n",
                   six_heights()));
  const auto channels = read_channels(path);
  ASSERT_EQ(channels.size(), 1U);
  const Channel& channel = channels.front();
  EXPECT_EQ(channel.name, "My map = nice");
  EXPECT_EQ(channel.unit, "m");
  EXPECT_EQ(channel.grid.nx, 3);
  EXPECT_EQ(channel.grid.ny, 2);
  EXPECT_DOUBLE_EQ(channel.grid.pitch_x.si(), 2e-3);  // XReal / XRes
  EXPECT_DOUBLE_EQ(channel.grid.pitch_y.si(), 4e-3);
  for (Index i = 0; i < 6; ++i) {
    EXPECT_DOUBLE_EQ(channel.values(i / 3, i % 3), 1e-6 * static_cast<double>(i + 1));
  }
}

TEST(Gsf, ReadsEveryLengthOfPadding) {
  const TestFolder folder;
  for (const std::string title : {"", "a", "ab", "abc", "abcd"}) {
    const auto path =
        folder.write("a.gsf", gsf("XRes = 3\nYRes = 2\nTitle = " + title + "\n", six_heights()));
    const auto channels = read_channels(path);
    EXPECT_EQ(channels.front().name, title);
    EXPECT_EQ(channels.front().values(1, 2), 6.0);
  }
}

TEST(Gsf, ReadsAHeaderOfAnyLength) {
  const TestFolder folder;
  // About 4096 bytes, where the first look at the file ends, and far beyond.
  for (std::size_t length = 4030; length < 4130; ++length) {
    const std::string title(length == 4129 ? 200000 : length, 't');
    const auto path =
        folder.write("a.gsf", gsf("XRes = 3\nYRes = 2\nTitle = " + title + "\n", six_heights()));
    const auto channels = read_channels(path);
    EXPECT_EQ(channels.front().name, title);
    EXPECT_EQ(channels.front().values(1, 2), 6.0);
  }
}

TEST(Gsf, WithoutSizeOrUnitTheScaleIsUnknown) {
  const TestFolder folder;
  const auto path = folder.write("a.gsf", gsf("XRes = 3\nYRes = 2\n", six_heights()));
  EXPECT_EQ(read_channels(path).front().grid.pitch_x, Length{});
  EXPECT_EQ(read_channels(path).front().unit, "");
  // A size without a unit, and one that is no length, are no scale either.
  for (const std::string more : {"XReal = 1\n", "XReal = 1\nXYUnits = s\n"}) {
    const auto other = folder.write("b.gsf", gsf("XRes = 3\nYRes = 2\n" + more, six_heights()));
    EXPECT_EQ(read_channels(other).front().grid.pitch_x, Length{});
  }
}

TEST(Gsf, NanAndInfinityAreMissing) {
  const TestFolder folder;
  const std::string data = little(1.0F) +
                           little(std::uint64_t{0x7f800001}, 4) /* signalling NaN */ +
                           little(std::uint64_t{0x7fc00000}, 4) /* NaN */ +
                           little(std::uint64_t{0xff800000}, 4) /* -inf */;
  const auto path = folder.write(
      "a.gsf", gsf("XRes = 2\nYRes = 2\nXReal = 1\nYReal = 1\nXYUnits = mm\nZUnits = m\n", data));
  const HeightMap map = read_height_map(path);
  EXPECT_EQ(map.flags()(0, 0), 0);
  EXPECT_EQ(map.height()(0, 0), 1.0);
  EXPECT_EQ(map.flags()(0, 1), PixelFlag::no_data);
  EXPECT_EQ(map.flags()(1, 0), PixelFlag::no_data);
  EXPECT_EQ(map.flags()(1, 1), PixelFlag::no_data);
}

TEST(Gsf, TooFewOrTooManyBytesAreCounted) {
  const TestFolder folder;
  const std::string header = "XRes = 3\nYRes = 2\n";
  const std::string cut = six_heights().substr(0, 23);
  EXPECT_TRUE(contains(refusal(folder, "a.gsf", gsf(header, cut)),
                       "23 bytes of heights follow its header, but XRes x YRes = 3 x 2 needs 24"));
  EXPECT_TRUE(
      contains(refusal(folder, "a.gsf", gsf(header, six_heights() + "x")), "25 bytes of heights"));
}

TEST(Gsf, FaultyHeadersAreNamed) {
  const TestFolder folder;
  const auto fault = [&](const std::string& header) {
    return refusal(folder, "a.gsf", gsf(header, six_heights()));
  };
  EXPECT_TRUE(contains(fault("YRes = 2\n"), "has no XRes"));
  EXPECT_TRUE(contains(fault("XRes = three\nYRes = 2\n"), "XRes is \"three\""));
  EXPECT_TRUE(contains(fault("XRes = -3\nYRes = 2\n"), "XRes is -3"));
  EXPECT_TRUE(contains(fault("XRes = 0\nYRes = 2\n"), "XRes is 0"));
  EXPECT_TRUE(contains(fault("XRes = 1.5\nYRes = 4\n"), "XRes is 1.5"));
  EXPECT_TRUE(contains(fault("XRes = 999999999\nYRes = 999999999\n"), "pixels"));
  EXPECT_TRUE(contains(fault("XRes = 3\nYRes = 2\nXRes = 3\n"), "XRes is given a second time"));
  EXPECT_TRUE(contains(fault("XRes = 3\nYRes = 2\nnonsense\n"), "a.gsf:4 | this header line"));
  const std::string size = "XRes = 3\nYRes = 2\nXYUnits = m\nXReal = ";
  EXPECT_TRUE(contains(fault(size + "0\n"), "XReal gives a pixel of 0 m"));
  EXPECT_TRUE(contains(fault(size + "-1\n"), "XReal"));
  EXPECT_TRUE(contains(fault(size + "nan\n"), "XReal is \"nan\""));
  EXPECT_TRUE(contains(fault(size + "1e305\n"), "XReal"));
  EXPECT_TRUE(contains(fault("XRes = 3\nYRes = 2\nZUnits = blub\n"), "unknown unit \"blub\""));
}

TEST(Gsf, EveryTruncationIsRefused) {
  const TestFolder folder;
  const std::string whole =
      gsf("XRes = 3\nYRes = 2\nXReal = 1\nYReal = 1\nXYUnits = m\nZUnits = m\n", six_heights());
  for (std::size_t length = 1; length < whole.size(); ++length) {
    const auto path = folder.write("cut.gsf", whole.substr(0, length));
    EXPECT_THROW(gsf_reader().read(path, {}), InputError) << length;
  }
  EXPECT_NO_THROW(gsf_reader().read(folder.write("whole.gsf", whole), {}));
}

TEST(Gsf, WritesWhatItReadsAndFlaggedPixelsAsNan) {
  const TestFolder folder;
  Array2 height(2, 3);
  height << 1e-9, -2.5e-6, 0.0, 3e-7, std::numeric_limits<double>::quiet_NaN(), 1e-30;
  Flags2 flags = Flags2::Zero(2, 3);
  flags(0, 1) = PixelFlag::spike;
  const HeightMap map(CameraGrid{3, 2, 1.6 * um, 13.0 * um}, height, flags);
  write_gsf(folder / "a.gsf", map, "two\nlines");
  const HeightMap back = read_height_map(folder / "a.gsf");
  EXPECT_EQ(read_channels(folder / "a.gsf").front().name, "two lines");
  // The file holds sizes, not pitches: one product and one quotient of round-off.
  EXPECT_NEAR(back.grid().pitch_x.si(), 1.6e-6, 4e-22);
  EXPECT_NEAR(back.grid().pitch_y.si(), 13e-6, 4e-21);
  for (Index i = 0; i < 6; ++i) {
    const bool good = map.flags().data()[i] == 0;
    EXPECT_EQ(back.flags().data()[i], good ? 0 : PixelFlag::no_data);
    if (good) {
      EXPECT_EQ(back.height().data()[i], static_cast<float>(height.data()[i]));
    }
  }
}

TEST(Gsf, HeightsBeyondAFloatAreNotWritten) {
  const TestFolder folder;
  const HeightMap map(CameraGrid{2, 2, 1.0 * um, 1.0 * um}, Array2::Constant(2, 2, 1e39));
  EXPECT_THROW(write_gsf(folder / "a.gsf", map, ""), InputError);
  EXPECT_FALSE(std::filesystem::exists(folder / "a.gsf"));
}

TEST(Gsf, ReadsEveryPixelOfAPracticeMap) {
  const auto path = testing::shared_data("practice/S1/h00.gsf");
  if (path.empty()) GTEST_SKIP() << "no practice data here";
  const HeightMap map = read_height_map(path);
  EXPECT_EQ(map.grid().nx, 1024);
  EXPECT_EQ(map.grid().ny, 192);
  EXPECT_DOUBLE_EQ(map.grid().size_x().si(), 0.0163);
  EXPECT_DOUBLE_EQ(map.grid().size_y().si(), 0.0025);
  // Independent of the header: the heights are the last 4 nx ny bytes of the file.
  const std::string bytes = testing::bytes_of(path);
  const char* heights = bytes.data() + bytes.size() - 4 * 1024 * 192;
  Index n_different = 0;
  for (Index i = 0; i < map.height().size(); ++i) {
    float value = 0.0F;
    std::memcpy(&value, heights + 4 * i, 4);
    const bool same = std::isfinite(value)
                          ? map.flags().data()[i] == 0 && map.height().data()[i] == value
                          : map.flags().data()[i] == PixelFlag::no_data;
    n_different += same ? 0 : 1;
  }
  EXPECT_EQ(n_different, 0);
}

}  // namespace
}  // namespace manoscope::io
