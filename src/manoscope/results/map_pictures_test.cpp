#include "manoscope/results/map_pictures.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "manoscope/core/error.hpp"
#include "manoscope/core/provenance.hpp"
#include "manoscope/results/write.hpp"
#include "tests/support/example_measurement.hpp"
#include "tests/support/example_pictures.hpp"
#include "tests/support/temporary_folder.hpp"

namespace manoscope::results {
namespace {

namespace fs = std::filesystem;
using test_support::TemporaryFolder;

Measurement with_pictures() {
  auto m = test_support::example_measurement({.n_x = 30, .n_levels = 4, .n_runs = 2});
  test_support::add_example_pictures(m);
  return m;
}

TEST(MapPictures, ComeBackAsTheyWere) {
  const TemporaryFolder folder;
  const Measurement m = with_pictures();
  write_result(folder.path(), m, {});
  const auto back = read_maps(folder.path(), read_result(folder.path()));
  ASSERT_EQ(back.size(), m.map_picture.size());
  for (std::size_t i = 0; i < back.size(); ++i) {
    EXPECT_TRUE((back[i].counts == m.map_picture[i].counts).all());
    EXPECT_EQ(back[i].step, m.map_picture[i].step);
    EXPECT_TRUE((back[i].x == m.map_picture[i].x).all());
    EXPECT_TRUE((back[i].z == m.map_picture[i].z).all());
  }
  EXPECT_EQ(read_maps(folder / "result.nc", m).size(), back.size());
}

TEST(MapPictures, HaveTheSameBytesEveryTime) {
  const TemporaryFolder folder;
  const Measurement m = with_pictures();
  write_map_pictures(folder / "a.nc", {}, m);
  write_map_pictures(folder / "b.nc", {}, m);
  EXPECT_TRUE(read_file(folder / "a.nc") == read_file(folder / "b.nc"));
}

TEST(MapPictures, AreNoneWhereTheFileIsMissingOrOfOtherMaps) {
  const TemporaryFolder folder;
  Measurement m = with_pictures();
  EXPECT_TRUE(read_maps(folder.path(), m).empty());
  write_map_pictures(folder / "maps.nc", {}, m);
  EXPECT_FALSE(read_maps(folder.path(), m).empty());
  m.map[1] = "another.gsf";
  EXPECT_TRUE(read_maps(folder.path(), m).empty());
}

TEST(MapPictures, OfAnEarlierResultGoWithIt) {
  const TemporaryFolder folder;
  Measurement m = with_pictures();
  write_result(folder.path(), m, {});
  EXPECT_TRUE(fs::exists(folder / "maps.nc"));
  m.map_picture.clear();
  write_result(folder.path(), m, {});
  EXPECT_FALSE(fs::exists(folder / "maps.nc"));
}

TEST(MapPictures, RefuseAFileThatIsNone) {
  const TemporaryFolder folder;
  const Measurement m = with_pictures();
  std::ofstream(folder / "maps.nc") << "no NetCDF";
  EXPECT_THROW(read_maps(folder.path(), m), InputError);
}

TEST(MapPictures, RefuseCountsAndStepsThatNoPictureHas) {
  const TemporaryFolder folder;
  Measurement m = with_pictures();
  m.map_picture[1].counts(3, 4) = MapPicture::kLargest + 1;
  write_map_pictures(folder / "maps.nc", {}, m);
  EXPECT_THROW(read_maps(folder.path(), m), InputError);
  m.map_picture[1].counts(3, 4) = -MapPicture::kLargest;
  write_map_pictures(folder / "maps.nc", {}, m);
  EXPECT_EQ(read_maps(folder.path(), m).size(), m.map.size());
  m.map_picture[2].step = 0.0;
  write_map_pictures(folder / "maps.nc", {}, m);
  EXPECT_THROW(read_maps(folder.path(), m), InputError);
}

TEST(MapPictures, MustBeOneAMapAndOfOneGrid) {
  const TemporaryFolder folder;
  Measurement m = with_pictures();
  m.map_picture.back().x[0] = -1.0;
  EXPECT_THROW(write_map_pictures(folder / "maps.nc", {}, m), InternalError);
  m.map_picture.pop_back();
  EXPECT_THROW(write_map_pictures(folder / "maps.nc", {}, m), InternalError);
}

}  // namespace
}  // namespace manoscope::results
