// What convert writes, read back and looked at from outside.
#include "manoscope/io/writer.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "manoscope/core/flags.hpp"
#include "manoscope/core/random.hpp"
#include "manoscope/io/reader.hpp"
#include "manoscope/io/test_files.hpp"

namespace manoscope::io {
namespace {

using testing::bytes_of;
using testing::contains;
using testing::TestFolder;

HeightMap noisy_map(bool holes = true) {
  RandomStream random(3, "writer");
  Array2 height(21, 30);
  Flags2 flags = Flags2::Zero(21, 30);
  for (Index i = 0; i < height.size(); ++i) {
    height.data()[i] = 1e-6 * random.normal();
    if (holes && random.uniform() < 0.1) flags.data()[i] = PixelFlag::no_data;
  }
  return HeightMap(CameraGrid{30, 21, 1.63 * um, 13.1 * um}, height, flags);
}

TEST(WriteMap, X3pKeepsEveryBit) {
  const TestFolder folder;
  for (const bool holes : {true, false}) {
    const HeightMap map = noisy_map(holes);
    write_map(folder / "a.x3p", map, "t");
    EXPECT_TRUE(read_channels(folder / "a.x3p").front().warnings.empty());  // checksums agree
    const HeightMap back = read_height_map(folder / "a.x3p");
    EXPECT_EQ(back.grid(), map.grid());
    EXPECT_TRUE((back.flags() == map.flags()).all());
    EXPECT_TRUE(((back.height() == map.height()) || (map.flags() != 0)).all());
    const std::string once = bytes_of(folder / "a.x3p");
    write_map(folder / "b.x3p", map, "t");
    EXPECT_EQ(bytes_of(folder / "b.x3p"), once);
  }
}

TEST(WriteMap, TiffKeepsScaleHolesAndHeightsToAFloat) {
  const TestFolder folder;
  const HeightMap map = noisy_map();
  write_map(folder / "a.tiff", map, "two\nlines");
  const HeightMap back = read_height_map(folder / "a.tiff");
  EXPECT_EQ(back.grid(), map.grid());
  EXPECT_TRUE((back.flags() == map.flags()).all());
  for (Index i = 0; i < map.height().size(); ++i) {
    if (map.flags().data()[i] != 0) continue;
    EXPECT_EQ(back.height().data()[i],
              static_cast<double>(static_cast<float>(map.height().data()[i])));
  }
}

TEST(WriteMap, VtiHoldsHeightsAndFlagsWhereItsHeaderSays) {
  const TestFolder folder;
  const HeightMap map = noisy_map();
  write_map(folder / "a.vti", map, "t");
  const std::string bytes = bytes_of(folder / "a.vti");
  EXPECT_TRUE(contains(bytes, "WholeExtent=\"0 29 0 20 0 0\""));
  EXPECT_TRUE(
      contains(bytes, "Name=\"flags\" format=\"appended\" offset=\"5048\""));  // 8 + 8 * 630
  const std::size_t start = bytes.find("encoding=\"raw\">\n_") + 17;
  EXPECT_EQ(bytes.substr(start, 8), testing::little(8 * 630, 8));
  EXPECT_EQ(bytes.substr(start + 5048, 8), testing::little(630, 8));
  for (std::size_t i = 0; i < 630; ++i) {
    const bool good = map.flags().data()[i] == 0;
    EXPECT_EQ(bytes[start + 5056 + i] == 0, good);
    if (good) {
      const auto bits = std::bit_cast<std::uint64_t>(map.height().data()[i]);
      EXPECT_EQ(bytes.substr(start + 8 + 8 * i, 8), testing::little(bits, 8));
    }
  }
  EXPECT_TRUE(bytes.ends_with("</AppendedData>\n</VTKFile>\n"));
}

TEST(Writer, NumbersFilesWithTheSameWidth) {
  EXPECT_EQ(numbered("d/a.b.gsf", 3, 12), "d/a.b-03.gsf");
  EXPECT_EQ(numbered("a.nc", 3, 9), "a-3.nc");
}

}  // namespace
}  // namespace manoscope::io
