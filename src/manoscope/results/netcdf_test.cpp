#include "manoscope/results/netcdf.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <netcdf.h>

#include <fstream>
#include <limits>

#include "manoscope/core/error.hpp"
#include "manoscope/core/provenance.hpp"
#include "manoscope/core/random.hpp"
#include "tests/support/example_measurement.hpp"
#include "tests/support/temporary_folder.hpp"

namespace manoscope::results {
namespace {

namespace fs = std::filesystem;
using test_support::example_measurement;
using test_support::ExampleSize;
using test_support::first_difference;
using test_support::TemporaryFolder;

Measurement round_trip(const Measurement& measurement) {
  const TemporaryFolder folder;
  write_netcdf(folder / "result.nc", {}, measurement, {"result.nc"});
  return read_netcdf(folder / "result.nc");
}

TEST(ResultFile, GivesBackEveryBitOfMeasurementsOfAnySize) {
  RandomStream random(7, "sizes");
  for (int i = 0; i < 25; ++i) {
    ExampleSize size;
    size.n_x = 1 + random.below(120);
    size.n_levels = 1 + random.below(25);
    size.n_runs = random.below(9);
    size.crossings = random.below(2) == 1;
    size.seed = static_cast<std::uint64_t>(i);
    const auto measurement = example_measurement(size);
    EXPECT_EQ(first_difference(round_trip(measurement), measurement), "")
        << size.n_x << " stations, " << size.n_levels << " levels, " << size.n_runs << " runs";
  }
}

TEST(ResultFile, GivesBackACalibrationWithoutRuns) {
  const auto measurement = example_measurement({.n_x = 30, .n_levels = 5, .n_runs = 0});
  ASSERT_TRUE(measurement.run.empty());
  ASSERT_EQ(measurement.crossing_x.size(), 0);
  const auto back = round_trip(measurement);
  EXPECT_EQ(first_difference(back, measurement), "");
  EXPECT_EQ(back.pressure.rows(), 0);
  EXPECT_EQ(back.budget_source, measurement.budget_source);
}

TEST(ResultFile, KeepsRowsAndColumnsOfTheCovarianceApart) {
  auto measurement = example_measurement({.n_x = 5, .n_levels = 3, .n_runs = 1});
  measurement.pressure_covariance[0] = Matrix::NullaryExpr(
      5, 5, [](Index row, Index column) { return static_cast<double>(10 * row + column); });
  EXPECT_EQ(first_difference(round_trip(measurement), measurement), "");
}

TEST(ResultFile, KeepsTextsOfAnyLengthAndAlphabet) {
  auto measurement = example_measurement({.n_x = 5, .n_levels = 3, .n_runs = 1});
  measurement.title = "Kanal № 3: 175 µm, ζ(x)";
  measurement.run[0] = "Lauf „α“";
  measurement.history.clear();
  measurement.warnings.clear();
  // A thousand maps and a long experiment file: past the 64 kB that HDF5 keeps with a header.
  for (int i = 0; i < 3000; ++i) measurement.inputs += "map.gsf  " + std::string(64, 'f') + "\n";
  measurement.experiment = std::string(100000, 'e');
  EXPECT_EQ(first_difference(round_trip(measurement), measurement), "");
}

TEST(ResultFile, KeepsAWarningOnOneLine) {
  auto measurement = example_measurement({.n_x = 5, .n_levels = 3, .n_runs = 1});
  measurement.warnings = {"one\nwarning", "another"};
  EXPECT_EQ(round_trip(measurement).warnings, (std::vector<std::string>{"one warning", "another"}));
}

TEST(ResultFile, HasTheSameBytesEveryTime) {
  const TemporaryFolder folder;
  const auto measurement = example_measurement();
  write_netcdf(folder / "a.nc", {}, measurement, {"result.nc"});
  write_netcdf(folder / "b.nc", {}, measurement, {"result.nc"});
  const std::string a = read_file(folder / "a.nc");
  EXPECT_GT(a.size(), 100000u);
  EXPECT_TRUE(a == read_file(folder / "b.nc"));
}

TEST(ResultFile, NamesTheFilesPublishedWithIt) {
  const TemporaryFolder folder;
  const auto measurement = example_measurement({.n_x = 5, .n_levels = 3, .n_runs = 1});
  write_netcdf(folder / "a.nc", {}, measurement, {"drops.csv", "figures/a.svg"});
  EXPECT_EQ(published_files(folder / "a.nc"),
            (std::vector<std::string>{"drops.csv", "figures/a.svg"}));
  EXPECT_TRUE(published_files(folder / "missing.nc").empty());
}

TEST(ResultFile, RefusesWhatIsMissingCutOrForeign) {
  const TemporaryFolder folder;
  EXPECT_THROW(read_netcdf(folder / "missing.nc"), InputError);
  std::ofstream(folder / "text.nc") << "not a NetCDF file";
  EXPECT_THROW(read_netcdf(folder / "text.nc"), InputError);

  write_netcdf(folder / "whole.nc", {},
               example_measurement({.n_x = 20, .n_levels = 3, .n_runs = 2}), {});
  const std::string bytes = read_file(folder / "whole.nc");
  for (const double part : {0.0, 0.01, 0.3, 0.7, 0.999}) {
    const auto length = static_cast<std::streamsize>(part * static_cast<double>(bytes.size()));
    std::ofstream(folder / "cut.nc", std::ios::binary).write(bytes.data(), length);
    EXPECT_THROW(read_netcdf(folder / "cut.nc"), InputError) << part;
  }
}

TEST(ResultFile, OfAnotherVersionIsNamedAsSuch) {
  const TemporaryFolder folder;
  auto measurement = example_measurement({.n_x = 5, .n_levels = 3, .n_runs = 1});
  const auto found_in = [&](const std::string& source) {
    measurement.source = source;
    write_netcdf(folder / "old.nc", {}, measurement, {});
    int id = 0, variable = 0;  // as if the schema had grown by map_shift since
    EXPECT_EQ(nc_open((folder / "old.nc").c_str(), NC_WRITE, &id), NC_NOERR);
    EXPECT_EQ(nc_inq_varid(id, "map_shift", &variable), NC_NOERR);
    EXPECT_EQ(nc_rename_var(id, variable, "map_place"), NC_NOERR);
    EXPECT_EQ(nc_close(id), NC_NOERR);
    try {
      read_netcdf(folder / "old.nc");
    } catch (const InputError& error) {
      return error.found() + ". " + error.mend();
    }
    return std::string("no fault");
  };
  const std::string old = found_in("manoscope 0.0.9 (abc)");
  EXPECT_EQ(old.rfind("written by another version of manoscope (0.0.9 (abc), this is ", 0), 0u);
  EXPECT_NE(old.find("has no variable map_shift. Measure again"), std::string::npos) << old;
  const std::string same = fmt::format("manoscope {} ({})", program_version(), source_revision());
  EXPECT_EQ(found_in(same).find("another version"), std::string::npos);
  EXPECT_EQ(found_in("someone else's").find("another version"), std::string::npos);
}

TEST(ResultFile, OfAFullSizeExperimentStaysBelow80Megabytes) {
  // 8 runs at 974 stations: 61 MB of covariance before compression.
  const auto measurement = example_measurement({.n_x = 974});
  const TemporaryFolder folder;
  write_netcdf(folder / "result.nc", {}, measurement, {});
  RecordProperty("bytes", std::to_string(fs::file_size(folder / "result.nc")));
  EXPECT_LT(fs::file_size(folder / "result.nc"), std::uintmax_t{80} << 20);
}

}  // namespace
}  // namespace manoscope::results
