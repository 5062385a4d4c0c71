#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <thread>

#include "manoscope/core/flags.hpp"
#include "manoscope/io/formats.hpp"
#include "manoscope/io/netcdf_handle.hpp"
#include "manoscope/io/test_classic_netcdf.hpp"
#include "manoscope/io/test_files.hpp"
#include "manoscope/io/writer.hpp"
#include "tests/support/paths.hpp"

namespace manoscope::io {
namespace {

using testing::ClassicNetcdf;
using testing::complaint;
using testing::contains;
using testing::TestFolder;

HeightMap small_map() {
  Array2 height(3, 4);
  for (Index i = 0; i < height.size(); ++i) {
    height.data()[i] = 1e-6 / static_cast<double>(i + 1);
  }
  Flags2 flags = Flags2::Zero(3, 4);
  flags(1, 2) = PixelFlag::no_data;
  return HeightMap(CameraGrid{4, 3, 1.5 * um, 2.5 * um}, height, flags);
}

/// height(y, x) of 2 x 3 values 1 ... 6 nm, laid out by hand.
ClassicNetcdf two_by_three() {
  ClassicNetcdf file;
  file.dimensions = {{"y", 2}, {"x", 3}};
  file.variables = {
      {"y", {0}, {{"units", "um"}}, {}, ClassicNetcdf::doubles({10.0, 14.0})},
      {"x", {1}, {{"units", "mm"}}, {}, ClassicNetcdf::doubles({-0.002, 0.0, 0.002})},
      {"height", {0, 1}, {{"units", "nm"}}, {}, ClassicNetcdf::doubles({1, 2, 3, 4, 5, 6})}};
  return file;
}

TEST(NetcdfMap, ReadsAClassicFileBuiltByHand) {
  const TestFolder folder;
  for (const int version : {1, 2, 5}) {
    const auto path = folder.write("a.nc", two_by_three().bytes(version));
    const HeightMap map = read_height_map(path);
    EXPECT_EQ(map.grid().nx, 3);
    EXPECT_EQ(map.grid().ny, 2);
    EXPECT_NEAR(map.grid().pitch_x.si(), 2e-6, 1e-20);  // round-off of unit conversion
    EXPECT_NEAR(map.grid().pitch_y.si(), 4e-6, 1e-20);
    for (Index i = 0; i < 6; ++i) {
      EXPECT_NEAR(map.height()(i / 3, i % 3), 1e-9 * static_cast<double>(i + 1), 1e-22);
    }
  }
}

TEST(NetcdfMap, DimensionsNamedXYAreTurnedIntoRowsAlongX) {
  const TestFolder folder;
  ClassicNetcdf file = two_by_three();
  file.dimensions = {{"x", 2}, {"y", 3}};
  file.variables[0].name = "x";
  file.variables[1].name = "y";
  const HeightMap map = read_height_map(folder.write("a.nc", file.bytes(1)));
  EXPECT_EQ(map.grid().nx, 2);
  EXPECT_EQ(map.grid().ny, 3);
  EXPECT_NEAR(map.grid().pitch_x.si(), 4e-6, 1e-20);
  EXPECT_NEAR(map.height()(2, 1), 6e-9, 1e-22);
  EXPECT_NEAR(map.height()(2, 0), 3e-9, 1e-22);
}

TEST(NetcdfMap, PackedValuesAndFillValuesAreHonoured) {
  const TestFolder folder;
  ClassicNetcdf file = two_by_three();
  auto& height = file.variables[2];
  height.type = 3;  // NC_SHORT
  height.data = testing::big(std::uint64_t{100}, 2) + testing::big(std::uint64_t{200}, 2) +
                testing::big(std::uint64_t{0xffff}, 2) /* -1 */ +
                testing::big(std::uint64_t{0x8001}, 2) /* -32767, the default fill */ +
                testing::big(std::uint64_t{7}, 2) + testing::big(std::uint64_t{0}, 2);
  height.numbers = {{"scale_factor", 0.5}, {"add_offset", 10.0}};
  {
    const HeightMap map = read_height_map(folder.write("a.nc", file.bytes(1)));
    EXPECT_NEAR(map.height()(0, 0), 60e-9, 1e-22);   // 0.5 * 100 + 10
    EXPECT_NEAR(map.height()(0, 2), 9.5e-9, 1e-22);  // 0.5 * -1 + 10
    EXPECT_EQ(map.flags()(1, 0), PixelFlag::no_data);
    EXPECT_EQ(map.flags().cast<int>().sum(), 1);
  }
  height.numbers.emplace_back("_FillValue", 7.0);
  const HeightMap map = read_height_map(folder.write("b.nc", file.bytes(1)));
  EXPECT_EQ(map.flags()(1, 1), PixelFlag::no_data);
  EXPECT_EQ(map.flags()(1, 0), 0);  // the file's own fill value takes the place of the default
}

TEST(NetcdfMap, FloatsWithSignallingNanAndDefaultFillAreMissing) {
  const TestFolder folder;
  ClassicNetcdf file = two_by_three();
  file.variables[2].type = 5;  // NC_FLOAT
  file.variables[2].data = testing::big(1.5F) + testing::big(std::uint64_t{0x7f800001}, 4) +
                           testing::big(std::uint64_t{0x7cf00000}, 4) /* NC_FILL_FLOAT */ +
                           testing::big(2.0F) + testing::big(3.0F) + testing::big(4.0F);
  const HeightMap map = read_height_map(folder.write("a.nc", file.bytes(1)));
  EXPECT_NEAR(map.height()(0, 0), 1.5e-9, 1e-22);
  EXPECT_EQ(map.flags()(0, 1), PixelFlag::no_data);
  EXPECT_EQ(map.flags()(0, 2), PixelFlag::no_data);
}

TEST(NetcdfMap, CoordinatesMustRiseEvenly) {
  const TestFolder folder;
  const auto fault = [&](const std::vector<double>& x) {
    ClassicNetcdf file = two_by_three();
    file.variables[1].data = ClassicNetcdf::doubles(x);
    return complaint([&] { read_channels(folder.write("a.nc", file.bytes(1))); });
  };
  EXPECT_EQ(fault({0.0, 1.0, 2.0}), "");
  EXPECT_EQ(fault({0.0, 1.0, 2.0 + 1e-6}), "");  // within the tolerance of 1e-6 of the length
  EXPECT_TRUE(contains(fault({0.0, 1.0, 2.0 + 1e-5}), "variable \"x\" | value 1 is 1, but even"));
  EXPECT_TRUE(contains(fault({0.0, 1.0, 3.0}), "even spacing"));
  EXPECT_TRUE(contains(fault({2.0, 1.0, 0.0}), "does not rise"));
  EXPECT_TRUE(contains(fault({1.0, 1.0, 1.0}), "does not rise"));
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(contains(fault({0.0, kNan, 2.0}), "does not rise"));
  EXPECT_TRUE(contains(fault({-1e308, 0.0, 1e308}), "does not rise"));
  EXPECT_TRUE(contains(fault({0.0, 1e50, 2e50}), "absurd"));
}

TEST(NetcdfMap, SeveralVariablesAreChannels) {
  const TestFolder folder;
  ClassicNetcdf file = two_by_three();
  file.variables.push_back(file.variables[2]);
  file.variables.back().name = "intensity";
  file.variables.back().texts = {{"units", "1"}};
  const auto path = folder.write("a.nc", file.bytes(1));
  const auto channels = read_channels(path);
  ASSERT_EQ(channels.size(), 2U);
  EXPECT_EQ(channels[1].name, "intensity");
  EXPECT_EQ(channels[1].unit, "1");
  EXPECT_NO_THROW(read_height_map(path));  // only one of the two is a length
}

TEST(NetcdfMap, TablesThatAreNoMapsAreRefused) {
  const TestFolder folder;
  ClassicNetcdf file = two_by_three();
  file.variables[0].texts = {{"units", "Pa"}};
  EXPECT_TRUE(contains(complaint([&] { read_channels(folder.write("a.nc", file.bytes(1))); }),
                       "holds no map"));
}

TEST(NetcdfMap, EveryTruncationOfAClassicFileIsRefused) {
  const TestFolder folder;
  const std::string whole = two_by_three().bytes(1);
  for (std::size_t length = 1; length < whole.size(); ++length) {
    const auto path = folder.write("cut.nc", whole.substr(0, length));
    EXPECT_THROW(netcdf_reader().read(path, {}), InputError) << length;
  }
}

TEST(NetcdfMap, CountsBeyondTheFileAreRefusedBeforeAnythingIsAllocated) {
  const TestFolder folder;
  ClassicNetcdf file = two_by_three();
  file.dimensions = {{"y", 30000}, {"x", 30000}};
  EXPECT_TRUE(contains(complaint([&] { read_channels(folder.write("a.nc", file.bytes(1))); }),
                       "should lie in bytes"));
  file.dimensions = {{"y", 0x7fffffff}, {"x", 0x7fffffff}};
  EXPECT_THROW(read_channels(folder.write("a.nc", file.bytes(1))), InputError);
}

TEST(NetcdfMap, WritesWhatItReadsBitForBit) {
  const TestFolder folder;
  const HeightMap map = small_map();
  write_netcdf_map(folder / "a.nc", map, "a title");
  const HeightMap back = read_height_map(folder / "a.nc");
  // Pitches come back from differences of coordinates: a few units in the last place.
  EXPECT_NEAR(back.grid().pitch_x.si(), 1.5e-6, 1e-20);
  EXPECT_NEAR(back.grid().pitch_y.si(), 2.5e-6, 1e-20);
  EXPECT_TRUE((back.flags() == map.flags()).all());
  for (Index i = 0; i < map.height().size(); ++i) {
    if (map.flags().data()[i] == 0) {
      EXPECT_EQ(back.height().data()[i], map.height().data()[i]);
    }
  }
}

TEST(NetcdfMap, SameMapSameBytesAtAnyTime) {
  const TestFolder folder;
  write_netcdf_map(folder / "a.nc", small_map(), "t");
  // Time stamps of HDF5 count seconds.
  std::this_thread::sleep_for(std::chrono::milliseconds(1100));
  write_netcdf_map(folder / "b.nc", small_map(), "t");
  EXPECT_EQ(testing::bytes_of(folder / "a.nc"), testing::bytes_of(folder / "b.nc"));
}

TEST(NetcdfMap, XarrayOpensIt) {
  const TestFolder folder;
  const std::string python = test_paths::python;
  if (std::system((python + " -c 'import xarray' 2>/dev/null").c_str()) != 0) {
    GTEST_SKIP() << "python3-xarray is not installed";
  }
  write_netcdf_map(folder / "a.nc", small_map(), "a title");
  const auto script = folder.write("check.py", R"(
import sys, numpy, xarray
with xarray.open_dataset(sys.argv[1]) as data:
    assert data.attrs["Conventions"] == "CF-1.10" and data.attrs["title"] == "a title"
    height = data["height"]
    assert height.dims == ("y", "x") and height.shape == (3, 4) and height.dtype == "float64"
    assert height.attrs["units"] == data["x"].attrs["units"] == data["y"].attrs["units"] == "m"
    assert numpy.allclose(data["x"], (numpy.arange(4) + 0.5) * 1.5e-6, rtol=1e-15)
    assert numpy.allclose(data["y"], (numpy.arange(3) + 0.5) * 2.5e-6, rtol=1e-15)
    truth = 1e-6 / numpy.arange(1.0, 13.0).reshape(3, 4)
    truth[1, 2] = numpy.nan
    assert numpy.array_equal(height.values, truth, equal_nan=True)
)");
  const std::string command = python + " " + script.string() + " " + (folder / "a.nc").string();
  EXPECT_EQ(std::system(command.c_str()), 0);
}

TEST(NetcdfMap, AFailedWriteLeavesTheOldFileAndNamesTheNewOne) {
  const TestFolder folder;
  EXPECT_TRUE(
      contains(complaint([&] { write_netcdf_map(folder / "absent/a.nc", small_map(), "t"); }),
               "absent/a.nc"));
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()),
                          std::filesystem::directory_iterator()),
            0);
}

TEST(NetcdfFile, HoldsStringsFlagsAndAttributes) {
  const TestFolder folder;
  {
    NetcdfFile file = NetcdfFile::create(folder / "a.nc");
    const int run = file.define_dimension("run", 2);
    const int label = file.define_string("run", {run});
    const int flags = file.define_ubyte("flags", {run});
    const int count = file.define_int("count", {run});
    file.put_attribute(flags, "flag_masks", std::vector<unsigned char>{1, 2});
    file.put_attribute(count, "offset", 2.5);
    file.write(label, std::vector<std::string>{"Q5", "Q70 \xC2\xB5L"});
    const std::vector<unsigned char> bits{3, 0};
    file.write(flags, bits.data());
    const std::vector<int> counts{-7, 9};
    file.write(count, counts.data());
    file.close();
  }
  const NetcdfFile file = NetcdfFile::open(folder / "a.nc");
  EXPECT_EQ(file.read_strings(*file.variable("run")),
            (std::vector<std::string>{"Q5", "Q70 \xC2\xB5L"}));
  EXPECT_EQ(file.read_ints(*file.variable("flags")), (std::vector<int>{3, 0}));
  EXPECT_EQ(file.read_doubles(*file.variable("count")), (std::vector<double>{-7.0, 9.0}));
  EXPECT_EQ(file.number_attribute(file.variable("count")->id, "offset"), 2.5);
  EXPECT_EQ(file.variable("absent"), std::nullopt);
  EXPECT_EQ(file.text_attribute(NetcdfFile::kGlobal, "absent"), std::nullopt);
}

TEST(NetcdfFile, RefusesWhatIsNotNetcdf) {
  const TestFolder folder;
  EXPECT_TRUE(contains(complaint([&] { NetcdfFile::open(folder.write("a.nc", "no such thing")); }),
                       "is not a NetCDF file"));
  EXPECT_THROW(NetcdfFile::open(folder / "absent.nc"), InputError);
  // The signature of HDF5, and nothing behind it.
  EXPECT_THROW(NetcdfFile::open(folder.write("b.nc", "\x89HDF\r\n\x1a\n")), InputError);
}

TEST(NetcdfMap, ReadsAFileOfAnotherProgram) {
  const auto path = testing::shared_data("maps/st_nc-1.nc");
  if (path.empty()) GTEST_SKIP() << "no sample of another program here";
  // heights(x, y): 5 along x, 10 down y, 1 nm apart, falling from 9 to -9 nm along y.
  const HeightMap map = read_height_map(path);
  EXPECT_EQ(map.grid().nx, 5);
  EXPECT_EQ(map.grid().ny, 10);
  EXPECT_NEAR(map.grid().pitch_x.si(), 1e-9, 1e-23);
  EXPECT_NEAR(map.grid().pitch_y.si(), 1e-9, 1e-23);
  for (Index iy = 0; iy < 10; ++iy) {
    EXPECT_NEAR(map.height()(iy, 2), (9.0 - 2.0 * static_cast<double>(iy)) * 1e-9, 1e-22);
  }
}

}  // namespace
}  // namespace manoscope::io
