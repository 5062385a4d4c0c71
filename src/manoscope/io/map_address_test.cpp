#include "manoscope/io/map_address.hpp"

#include <gtest/gtest.h>

#include <cstring>

#include "manoscope/io/reader.hpp"
#include "manoscope/io/test_files.hpp"
#include "manoscope/io/test_gwy.hpp"
#include "manoscope/io/test_tiff.hpp"

namespace manoscope::io {
namespace {

using testing::complaint;
using testing::contains;
using testing::TestFolder;

bool same_bits(const Array2& a, const Array2& b) {
  return a.rows() == b.rows() && a.cols() == b.cols() &&
         std::memcmp(a.data(), b.data(), static_cast<std::size_t>(a.size()) * sizeof(double)) == 0;
}

TEST(MapAddress, TakesTheNumberOffAName) {
  EXPECT_EQ(map_address("a.tif#3").file, "a.tif");
  EXPECT_EQ(map_address("a.tif#3").page, 3);
  EXPECT_EQ(map_address("dir#2/a.tif").file, "dir#2/a.tif");
  for (const char* name : {"a.tif", "a#b.tif", "a.tif#", "#3", "a.tif#0", "a.tif#-1", "a.tif#2x",
                           "a.tif#99999999999"}) {
    EXPECT_EQ(map_address(name).file, name);
    EXPECT_EQ(map_address(name).page, 0) << name;
  }
}

TEST(MapAddress, AFileOfThatWholeNameComesFirst) {
  const TestFolder folder;
  folder.write("map#2", "x");
  EXPECT_EQ(map_address(folder / "map#2").page, 0);
  EXPECT_EQ(map_address(folder / "map#3").page, 3);
}

TEST(Pages, OfATiffAreTakenByTheirNumber) {
  const TestFolder folder;
  testing::TiffPage page;
  page.description = "ImageJ=1.53t\nunit=um\nvunit=nm\ncf=0\nc0=0\nc1=1\n";
  page.per_unit_x = page.per_unit_y = 0.5;
  std::vector<testing::TiffPage> pages;
  for (const float first : {1.0F, 10.0F, 100.0F}) {
    page.data = testing::tiff_floats(first);
    pages.push_back(page);
  }
  const auto path = folder.write("a.tif", testing::tiff_file(pages));
  const auto all = read_channels(path);
  ASSERT_EQ(all.size(), 3U);
  for (int n = 1; n <= 3; ++n) {
    const auto one = read_channels(path.string() + "#" + std::to_string(n));
    ASSERT_EQ(one.size(), 1U);
    EXPECT_EQ(one[0].page, n);
    EXPECT_TRUE(same_bits(one[0].values, all[static_cast<std::size_t>(n) - 1].values));
    ReadOptions options;
    options.page = n;
    EXPECT_TRUE(same_bits(read_channels(path, options)[0].values, one[0].values));
  }
  EXPECT_TRUE(contains(complaint([&] { read_height_map(path.string() + "#4"); }), "has no page 4"));
  EXPECT_TRUE(contains(complaint([&] { read_height_map(path); }), "#1 \"page 1\""));
  ReadOptions options;
  options.page = 2;
  EXPECT_TRUE(contains(complaint([&] { read_height_map(path.string() + "#3", options); }),
                       "names page 3, --page names 2"));
  options.page = -1;
  EXPECT_TRUE(contains(complaint([&] { read_height_map(path, options); }), "--page"));
}

TEST(Pages, OfAFileOfChannelsAreTheirPlaces) {
  using testing::gwy_component;
  const TestFolder folder;
  const std::vector<double> low{1e-6, 2e-6, 3e-6, 4e-6, 5e-6, 6e-6}, high(6, 7e-6);
  const auto path = folder.write(
      "a.gwy", testing::gwy_file(gwy_component("/0/data", 'o', testing::gwy_field(low, "m")) +
                                 gwy_component("/4/data", 'o', testing::gwy_field(high, "m"))));
  ASSERT_EQ(read_channels(path).size(), 2U);
  EXPECT_EQ(read_channels(path.string() + "#2")[0].values(0, 0), 7e-6);
  EXPECT_TRUE(contains(complaint([&] { read_channels(path.string() + "#3"); }), "has no page 3"));
}

}  // namespace
}  // namespace manoscope::io
