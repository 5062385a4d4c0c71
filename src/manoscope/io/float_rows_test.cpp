#include "manoscope/io/float_rows.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "manoscope/io/reader.hpp"
#include "manoscope/io/test_files.hpp"
#include "manoscope/io/writer.hpp"

namespace manoscope::io {
namespace {

using testing::complaint;
using testing::contains;
using testing::TestFolder;

HeightMap numbered(Index nx, Index ny) {
  Array2 height(ny, nx);
  for (Index i = 0; i < height.size(); ++i) height.data()[i] = 1e-9 * static_cast<double>(i);
  return {{nx, ny, 1.5 * um, 2.5 * um}, height};
}

std::vector<float> all_rows(FloatRows& file) {
  std::vector<float> values;
  const auto row_bytes = 4 * static_cast<std::size_t>(file.grid().nx);
  for (auto rows = file.next(); !rows.empty(); rows = file.next()) {
    EXPECT_EQ(rows.size() % row_bytes, 0U);
    const std::size_t before = values.size();
    values.resize(before + rows.size() / 4);
    std::memcpy(values.data() + before, rows.data(), rows.size());
  }
  return values;
}

TEST(FloatRows, AreTheRowsOfTheMapWhateverItsSizeInPieces) {
  const TestFolder folder;
  // Less than a piece; several pieces that end within rows; a row longer than a piece.
  for (const auto& [nx, ny] : {std::pair<Index, Index>{3, 2}, {333, 517}, {50001, 3}}) {
    const HeightMap map = numbered(nx, ny);
    const auto path = folder.path() / "a.gsf";
    write_map(path, map, "numbered");
    FloatRows file(path);
    EXPECT_EQ(file.grid(), read_height_map(path).grid());
    EXPECT_EQ(file.metres_per_unit(), 1.0);
    const std::vector<float> values = all_rows(file);
    ASSERT_EQ(values.size(), static_cast<std::size_t>(nx * ny));
    for (std::size_t i = 0; i < values.size(); ++i) {
      ASSERT_EQ(values[i], static_cast<float>(map.height().data()[i]));
    }
    const auto raw =
        folder.write("a.f32", {reinterpret_cast<const char*>(values.data()), 4 * values.size()});
    FloatRows same(raw, {map.grid(), 1e-6});
    EXPECT_EQ(all_rows(same), values);
    EXPECT_EQ(same.metres_per_unit(), 1e-6);
  }
}

TEST(FloatRows, ScaleTheUnitOfTheFile) {
  const TestFolder folder;
  std::string bytes =
      "Gwyddion Simple Field 1.0\nXRes = 2\nYRes = 2\nXReal = 1\nYReal = 1\n"
      "XYUnits = mm\nZUnits = um\n";
  bytes.append(4 - bytes.size() % 4, '\0');
  FloatRows file(folder.write("a.gsf", bytes + std::string(16, '\0')));
  EXPECT_DOUBLE_EQ(file.metres_per_unit(), 1e-6);
  EXPECT_DOUBLE_EQ(file.grid().pitch_x.si(), 0.5e-3);
}

TEST(FloatRows, RefuseWhatIsNoMapOfHeights) {
  const TestFolder folder;
  const auto gsf = [&](const std::string& lines) {
    std::string bytes = "Gwyddion Simple Field 1.0\nXRes = 2\nYRes = 2\n" + lines;
    bytes.append(4 - bytes.size() % 4, '\0');
    return folder.write("a.gsf", bytes + std::string(16, '\0'));
  };
  const auto opened = [](const std::filesystem::path& path) {
    return complaint([&] { const FloatRows file(path); });
  };
  EXPECT_TRUE(contains(opened(gsf("XReal=1\nYReal=1\nXYUnits=m\n")), "unit of length"));
  EXPECT_TRUE(contains(opened(gsf("XReal=1\nYReal=1\nXYUnits=m\nZUnits=V\n")), "unit of length"));
  EXPECT_TRUE(contains(opened(gsf("ZUnits=m\n")), "lateral scale"));
  EXPECT_TRUE(contains(opened(folder.write("b.gsf", "Gwyddion Simple")), "does not begin"));
  EXPECT_TRUE(contains(opened(folder.path() / "none.gsf"), "no such file"));
  EXPECT_TRUE(contains(opened(folder.path()), "not a regular file"));
}

TEST(FloatRows, RefuseRawFloatsOfAnotherSize) {
  const TestFolder folder;
  const auto path = folder.write("a.f32", std::string(20, '\0'));
  const RawFloats layout{{3, 2, 1.0 * um, 1.0 * um}, 1.0};
  const std::string told = complaint([&] { const FloatRows file(path, layout); });
  EXPECT_TRUE(contains(told, "20 bytes")) << told;
  EXPECT_TRUE(contains(told, "need 24")) << told;
}

TEST(FloatRows, SayWhenTheFileShrinksMeanwhile) {
  const TestFolder folder;
  const auto path = folder.write("a.f32", std::string(1 << 20, '\0'));
  FloatRows file(path, {{1024, 256, 1.0 * um, 1.0 * um}, 1.0});
  ASSERT_FALSE(file.next().empty());
  std::filesystem::resize_file(path, 1000);
  const std::string told = complaint([&] {
    while (!file.next().empty()) {
    }
  });
  EXPECT_TRUE(contains(told, "shorter")) << told;
}

}  // namespace
}  // namespace manoscope::io
