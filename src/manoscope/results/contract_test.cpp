#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <string>

#include "manoscope/results/write.hpp"
#include "tests/support/example_measurement.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/temporary_folder.hpp"

namespace manoscope::results {
namespace {

namespace fs = std::filesystem;
using test_support::example_measurement;
using test_support::TemporaryFolder;

struct Outcome {
  int status = -1;
  std::string output;
};

Outcome run_python(const std::string& arguments) {
  const std::string command = std::string(test_paths::python) + " " + arguments + " 2>&1";
  Outcome outcome;
  FILE* pipe = ::popen(command.c_str(), "r");
  std::array<char, 4096> buffer{};
  while (pipe != nullptr && std::fgets(buffer.data(), buffer.size(), pipe) != nullptr) {
    outcome.output += buffer.data();
  }
  if (pipe != nullptr) outcome.status = ::pclose(pipe);
  return outcome;
}

bool python_is_equipped() {
  return run_python("-c 'import xarray, netCDF4, h5netcdf'").status == 0;
}

Outcome check_contract(const fs::path& path) {
  return run_python(std::string(test_paths::source) + "/tests/python/result_contract_test.py '" +
                    path.string() + "'");
}

TEST(ResultContract, IsKeptAsXarrayReadsIt) {
  if (!python_is_equipped()) GTEST_SKIP() << "python3 with xarray, netCDF4 and h5netcdf not here";
  const TemporaryFolder folder;
  write_result(folder.path(), example_measurement(), {});
  const Outcome outcome = check_contract(folder / "result.nc");
  EXPECT_EQ(outcome.status, 0) << outcome.output;
  EXPECT_NE(outcome.output.find(" 0 faults"), std::string::npos) << outcome.output;
}

TEST(ResultContract, IsKeptByACalibrationWithoutRuns) {
  if (!python_is_equipped()) GTEST_SKIP() << "python3 with xarray, netCDF4 and h5netcdf not here";
  const TemporaryFolder folder;
  write_result(folder.path(), example_measurement({.n_x = 30, .n_levels = 4, .n_runs = 0}), {});
  const Outcome outcome = check_contract(folder.path());
  EXPECT_EQ(outcome.status, 0) << outcome.output;
}

TEST(ResultContract, CheckFindsABrokenPromise) {
  if (!python_is_equipped()) GTEST_SKIP() << "python3 with xarray, netCDF4 and h5netcdf not here";
  const TemporaryFolder folder;
  auto measurement = example_measurement({.n_x = 30, .n_levels = 4, .n_runs = 2});
  measurement.pressure(0, 15) = std::numeric_limits<double>::quiet_NaN();  // and no flag
  measurement.pressure_covariance[1](14, 14) *= 2.0;
  write_result(folder.path(), measurement, {});
  fs::remove(folder / "drops.csv");
  const Outcome outcome = check_contract(folder.path());
  EXPECT_NE(outcome.status, 0);
  EXPECT_NE(outcome.output.find("NaN and flags disagree at 1 stations"), std::string::npos)
      << outcome.output;
  EXPECT_NE(outcome.output.find("covariance of Q10: diagonal"), std::string::npos)
      << outcome.output;
  EXPECT_NE(outcome.output.find("drops.csv: missing"), std::string::npos) << outcome.output;
}

}  // namespace
}  // namespace manoscope::results
