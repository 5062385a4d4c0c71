// Maps in HDF5 of several kinds, written by h5py: Zygo .datx, MATLAB 7.3, plain HDF5; NetCDF-4 by
// the NetCDF library.
#include <gtest/gtest.h>
#include <hdf5.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>

#include "manoscope/core/flags.hpp"
#include "manoscope/io/map_summary.hpp"
#include "manoscope/io/netcdf_handle.hpp"
#include "manoscope/io/reader.hpp"
#include "manoscope/io/test_files.hpp"
#include "tests/support/paths.hpp"

namespace manoscope::io {
namespace {

using testing::complaint;
using testing::contains;
using testing::TestFolder;

class Hdf5Maps : public ::testing::Test {
 protected:
  void SetUp() override {
    const std::string probe = std::string(test_paths::python) + " -c 'import h5py' 2>/dev/null";
    if (std::system(probe.c_str()) != 0) GTEST_SKIP() << "python3-h5py is not installed";
  }
  /// Runs `body` with an open file `f` of that name.
  std::filesystem::path made(const std::string& name, const std::string& body,
                             const std::string& more = "") {
    const auto path = folder_ / name;
    const auto script =
        folder_.write("make.py", "import h5py, numpy as np\nwith h5py.File(r'" + path.string() +
                                     "', 'w'" + more + ") as f:\n" + body);
    const std::string command = std::string(test_paths::python) + " " + script.string();
    EXPECT_EQ(std::system(command.c_str()), 0);
    return path;
  }
  TestFolder folder_;
};

/// A .datx of 2 rows and 3 columns, without its scale; `more` may add to the surface `s`.
std::string datx_script(const std::string& unit, const std::string& more = "") {
  return R"(
    s = f.create_dataset('Data/Surface/{A}', data=np.array([[1., 2., 3.], [4., 5., 1e300]]))
    s.attrs.create('Unit', [')" +
         unit + R"('], dtype=h5py.string_dtype('ascii'))
    s.attrs['No Data'] = np.array([1e300])
    i = f.create_dataset('Data/Intensity/{B}', data=np.array([[7, 8], [9, 10]], dtype='i4'))
    f.create_group('Attributes/{C}').attrs['Objective'] = '10x Mirau'
    f['Attributes/{C}'].attrs['Data Context.Lateral Resolution:Value'] = np.array([2e-6])
)" + more;
}

/// Adds a converter {"LateralCat", "Pixels", {0, pitch}} to the surface, as Mx writes it: a
/// compound of two texts and a list, which h5py reads and cannot write.
void add_converter(const std::filesystem::path& path, const char* name, double pitch) {
  struct Converter {
    const char* category;
    const char* unit;
    hvl_t parameters;
  };
  double parameters[2] = {0.0, pitch};
  const Converter converter{"LateralCat", "Pixels", {2, parameters}};
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  const hid_t text = H5Tcopy(H5T_C_S1), list = H5Tvlen_create(H5T_NATIVE_DOUBLE);
  H5Tset_size(text, H5T_VARIABLE);
  const hid_t type = H5Tcreate(H5T_COMPOUND, sizeof(Converter));
  H5Tinsert(type, "Category", offsetof(Converter, category), text);
  H5Tinsert(type, "BaseUnit", offsetof(Converter, unit), text);
  H5Tinsert(type, "Parameters", offsetof(Converter, parameters), list);
  const hsize_t one = 1;
  const hid_t space = H5Screate_simple(1, &one, nullptr);
  const hid_t attribute = H5Acreate_by_name(file, "/Data/Surface/{A}", name, type, space,
                                            H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  EXPECT_GE(H5Awrite(attribute, type, &converter), 0);
  H5Aclose(attribute);
  H5Sclose(space);
  for (const hid_t id : {type, list, text}) H5Tclose(id);
  H5Fclose(file);
}

TEST_F(Hdf5Maps, ADatxIsReadWithItsScaleAndItsMissingPixels) {
  const auto path = made("a.datx", datx_script("MicroMeters", R"(
    where = np.zeros(1, dtype=[('ColumnStart', 'i4'), ('ColumnWidth', 'i4'), ('RowStart', 'i4')])
    where['ColumnStart'], where['RowStart'] = 139, 38
    s.attrs['Coordinates'] = where
)"));
  add_converter(path, "X Converter", 1.5e-6);
  EXPECT_EQ(find_reader(path).name(), "zygo-datx");
  const auto channels = read_channels(path);
  ASSERT_EQ(channels.size(), 2U);
  const Channel& surface = channels[0];
  EXPECT_EQ(surface.name, "Surface");
  EXPECT_EQ(surface.unit, "m");
  EXPECT_EQ(surface.grid.nx, 3);
  EXPECT_EQ(surface.grid.ny, 2);
  EXPECT_DOUBLE_EQ(surface.grid.pitch_x.si(), 1.5e-6);
  EXPECT_DOUBLE_EQ(surface.grid.pitch_y.si(), 2e-6);  // without a converter: Lateral Resolution
  EXPECT_NEAR(surface.values(1, 0), 4e-6, 1e-20);
  EXPECT_TRUE(std::isnan(surface.values(1, 2)));
  EXPECT_EQ(surface.offset_x, 139);
  EXPECT_EQ(surface.offset_y, 38);
  EXPECT_EQ(surface.settings.back(),
            (std::pair<std::string, std::string>("Objective", "10x Mirau")));
  EXPECT_EQ(channels[1].unit, "1");
  EXPECT_EQ(channels[1].values(1, 1), 10.0);
}

TEST_F(Hdf5Maps, FringesOfADatxAreScaledByWavelengthAndFactors) {
  const auto path = made("a.datx", datx_script("Fringes", R"(
    s.attrs['Wavelength'] = np.array([632.8e-9])
    s.attrs['Interferometric Scale Factor'] = np.array([0.5])
    s.attrs['Obliquity Factor'] = np.array([1.1])
)"));
  EXPECT_NEAR(read_height_map(path).height()(0, 1), 2 * 632.8e-9 * 0.5 * 1.1, 1e-20);
  const auto bare = made("b.datx", datx_script("Fringes"));
  EXPECT_TRUE(contains(complaint([&] { read_height_map(bare); }), "names no wavelength"));
  const auto odd = made("c.datx", datx_script("Furlongs per pint"));
  EXPECT_TRUE(contains(complaint([&] { read_height_map(odd); }), "in which unit"));
}

TEST_F(Hdf5Maps, ADatxUnderAnotherNameIsKnownByWhatItHolds) {
  EXPECT_NEAR(read_height_map(made("a.h5", datx_script("NanoMeters"))).height()(0, 1), 2e-9, 1e-23);
}

TEST_F(Hdf5Maps, ADatxWithoutASurfaceIsRefused) {
  const auto path = made("a.datx", "    f['x'] = np.arange(3.)\n");
  EXPECT_TRUE(contains(complaint([&] { read_channels(path); }), "without the surface of a .datx"));
}

TEST(Datx, TheCropOfAMetroProMapHasTheHeightsOfThatMap) {
  const auto crop = testing::shared_data("maps/synth_from_prysm_crop.datx");
  const auto whole = testing::shared_data("maps/pr_valid_zygo_dat_file.dat");
  if (crop.empty() || whole.empty()) GTEST_SKIP() << "no sample files here";
  const HeightMap small = read_height_map(crop), large = read_height_map(whole);
  // Rows are rows: 160 of them, of 200 pixels each, from the top left corner.
  ASSERT_EQ(small.grid().nx, 200);
  ASSERT_EQ(small.grid().ny, 160);
  EXPECT_NEAR(small.grid().pitch_x / large.grid().pitch_x, 1.0, 1e-7);  // a 32-bit number there
  for (Index iy = 0; iy < 160; ++iy) {
    for (Index ix = 0; ix < 200; ++ix) {
      ASSERT_EQ(small.flags()(iy, ix), large.flags()(iy, ix)) << iy << ' ' << ix;
      if (small.flags()(iy, ix) != 0) continue;
      // The two formats keep wavelength and factors as 32- and 64-bit numbers.
      ASSERT_NEAR(small.height()(iy, ix), large.height()(iy, ix), 1e-7 * 3e-7) << iy << ' ' << ix;
    }
  }
}

TEST_F(Hdf5Maps, PlainHdf5TakesUnitAndPitchFromTheUser) {
  const auto path = made("a.h5",
                         "    f['scan/height'] = np.arange(6.).reshape(2, 3)\n"
                         "    f['scan/mask'] = np.ones((2, 3), dtype='u1')\n"
                         "    f['scan/time'] = np.arange(3.)\n");
  EXPECT_EQ(find_reader(path).name(), "hdf5");
  EXPECT_TRUE(contains(complaint([&] { read_height_map(path); }), "--height-unit"));
  ReadOptions options;
  options.height_unit = "nm";
  EXPECT_TRUE(contains(complaint([&] { read_height_map(path, options); }), "--pitch-x"));
  options.pitch_x = options.pitch_y = 2.0 * um;
  const HeightMap map = read_height_map(path, options);
  EXPECT_EQ(map.grid(), (CameraGrid{3, 2, 2.0 * um, 2.0 * um}));
  EXPECT_NEAR(map.height()(1, 0), 3e-9, 1e-23);
  for (const char* name : {"scan/height", "/scan/height", "height"}) {
    options.channel = name;
    EXPECT_NEAR(read_height_map(path, options).height()(1, 2), 5e-9, 1e-23) << name;
  }
}

TEST_F(Hdf5Maps, SeveralArraysAreListedWithTheirSizes) {
  const auto path = made("a.h5",
                         "    f['up'] = np.ones((2, 3))\n    f['down'] = np.ones((4, 5))\n"
                         "    f['other/down'] = np.ones((4, 5))\n");
  ReadOptions options;
  options.height_unit = "nm";
  options.pitch_x = options.pitch_y = 2.0 * um;
  const std::string text = complaint([&] { read_height_map(path, options); });
  EXPECT_TRUE(
      contains(text, "#1 \"down\" 5 x 4 [m], #2 \"other/down\" 5 x 4 [m], #3 \"up\" 3 x 2"));
  EXPECT_TRUE(contains(text, "--channel"));
  options.channel = "sown";
  EXPECT_TRUE(contains(complaint([&] { read_height_map(path, options); }),
                       "(did you mean \"down\"?); it has \"down\" 5 x 4"));
  options.channel = "";
  EXPECT_EQ(read_height_map(path.string() + "#3", options).grid().nx, 3);
}

TEST_F(Hdf5Maps, VectorsBesideTheMapGiveItsScale) {
  const auto path = made("a.h5",
                         "    f['z'] = np.zeros((2, 3)); f['z'].attrs['units'] = 'um'\n"
                         "    f['x'] = np.arange(3) * 0.5; f['x'].attrs['units'] = 'mm'\n"
                         "    f['y'] = np.arange(2) * 0.25\n");
  ReadOptions options;
  options.lateral_unit = "cm";  // for the one that names no unit
  const HeightMap map = read_height_map(path, options);
  EXPECT_NEAR(map.grid().pitch_x.si(), 0.5e-3, 1e-18);
  EXPECT_NEAR(map.grid().pitch_y.si(), 0.25e-2, 1e-17);
}

TEST_F(Hdf5Maps, FillValuesAreMissing) {
  const auto path = made("a.h5",
                         "    d = f.create_dataset('z', data=np.array([[1., -999.], [3., 4.]]))\n"
                         "    d.attrs['_FillValue'] = -999.; d.attrs['unit'] = 'nm'\n");
  ReadOptions options;
  options.pitch_x = options.pitch_y = 1.0 * um;
  const HeightMap map = read_height_map(path, options);
  EXPECT_EQ(map.flags()(0, 1), PixelFlag::no_data);
  EXPECT_EQ(map.flags().cast<int>().sum(), static_cast<int>(PixelFlag::no_data));
}

TEST_F(Hdf5Maps, AStackIsASeriesOfFrames) {
  const auto path = made("a.h5", "    f['z'] = np.arange(24.).reshape(4, 2, 3)\n");
  ReadOptions options;
  options.height_unit = "nm";
  options.pitch_x = options.pitch_y = 1.0 * um;
  const MapSummary summary = summarise_map(path, options);
  ASSERT_EQ(summary.channels.size(), 4U);
  EXPECT_EQ(summary.channels[2].page, 3);
  EXPECT_TRUE(contains(complaint([&] { read_height_map(path, options); }), "FILE#2"));
  EXPECT_NEAR(read_height_map(path.string() + "#3", options).height()(0, 0), 12e-9, 1e-22);
  EXPECT_TRUE(contains(complaint([&] { read_height_map(path.string() + "#5", options); }),
                       "has no page 5; it has \"z\" 3 x 2, 4 frames"));
}

TEST_F(Hdf5Maps, ValuesInOtherFilesAreNotFollowed) {
  folder_.write("secret.bin", std::string(48, 'x'));
  const auto path = made("a.h5", "    f.create_dataset('z', (2, 3), 'f8', external=[('" +
                                     (folder_ / "secret.bin").string() + "', 0, 48)])\n");
  EXPECT_TRUE(contains(complaint([&] { read_channels(path); }), "holds no array of numbers"));
  const auto linked = made("b.h5", "    f['z'] = h5py.ExternalLink('a.h5', '/z')\n");
  EXPECT_TRUE(contains(complaint([&] { read_channels(linked); }), "holds no array of numbers"));
}

TEST_F(Hdf5Maps, Matlab73IsTurnedFromItsColumns) {
  const auto path = made("a.mat",
                         "    for n, v in (('h', np.arange(6.).reshape(2, 3)),\n"
                         "                 ('scan/k', np.arange(24.).reshape(4, 2, 3))):\n"
                         "        f[n] = v.T if v.ndim == 2 else v.transpose(0, 2, 1)\n"
                         "        f[n].attrs['MATLAB_class'] = np.bytes_('double')\n"
                         "    f['t'] = np.ones((2, 3), 'u2')\n"
                         "    f['t'].attrs['MATLAB_class'] = np.bytes_('char')\n",
                         ", userblock_size=512");
  std::string bytes = testing::bytes_of(path);
  std::string head = "MATLAB 7.3 MAT-file, Platform: GLNXA64, Created by: a test";
  head.resize(124, ' ');
  bytes.replace(0, 128, head + std::string("\0\x02IM", 4));
  folder_.write("a.mat", bytes);
  EXPECT_EQ(find_reader(path).name(), "matlab");
  const auto channels = read_channels(path);
  ASSERT_EQ(channels.size(), 5U);
  EXPECT_EQ(channels[0].name, "h");
  EXPECT_EQ(channels[0].grid.nx, 3);
  EXPECT_EQ(channels[0].values(1, 0), 3.0);
  EXPECT_EQ(channels[3].name, "scan/k");
  EXPECT_EQ(channels[3].page, 3);
  EXPECT_EQ(channels[3].values(0, 1), 13.0);
}

TEST(NetcdfSeries, TheDimensionBeforeTheMapCountsItsFrames) {
  const TestFolder folder;
  {
    NetcdfFile file = NetcdfFile::create(folder / "a.nc");
    const int t = file.define_dimension("time", 3), y = file.define_dimension("y", 2),
              x = file.define_dimension("x", 4);
    for (const auto& [name, dimension, n] :
         {std::tuple{"time", t, 3}, std::tuple{"y", y, 2}, std::tuple{"x", x, 4}}) {
      const int axis = file.define_double(name, {dimension});
      file.put_attribute(axis, "units", std::string(dimension == t ? "s" : "um"));
      std::vector<double> values(static_cast<std::size_t>(n));
      for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<double>(i);
      file.write(axis, values.data());
    }
    const int height = file.define_double("height", {t, y, x});
    const int light = file.define_double("light", {t, y, x});
    file.put_attribute(height, "units", std::string("nm"));
    file.put_attribute(light, "units", std::string("1"));
    std::vector<double> values(24);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<double>(i);
    file.write(height, values.data());
    file.write(light, values.data());
    file.close();
  }
  const auto channels = read_channels(folder / "a.nc");
  ASSERT_EQ(channels.size(), 6U);
  EXPECT_EQ(channels[1].name, "height");
  EXPECT_EQ(channels[1].page, 2);
  EXPECT_NEAR(read_height_map((folder / "a.nc#2").string()).height()(1, 3), 15e-9, 1e-22);
  EXPECT_TRUE(contains(complaint([&] { read_height_map(folder / "a.nc"); }), "more than one"));
  const auto maps = load_height_maps(folder / "a.nc");
  ASSERT_EQ(maps.size(), 3U);
  EXPECT_EQ(maps[2].first, 3);
  EXPECT_NEAR(maps[2].second.map.height()(0, 0), 16e-9, 1e-22);
}

}  // namespace
}  // namespace manoscope::io
