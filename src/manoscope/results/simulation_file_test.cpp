#include "manoscope/results/simulation_file.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "manoscope/core/error.hpp"
#include "manoscope/core/provenance.hpp"
#include "manoscope/results/simulation_schema.hpp"
#include "manoscope/results/simulation_table.hpp"
#include "manoscope/results/write.hpp"
#include "tests/support/as_ordinary_user.hpp"
#include "tests/support/example_measurement.hpp"
#include "tests/support/example_simulation.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/temporary_folder.hpp"

namespace manoscope::results {
namespace {

namespace fs = std::filesystem;
using test_support::example_simulation;
using test_support::TemporaryFolder;

/// Empty if both hold the same; else the name of the first variable that differs.
struct Differs {
  const Simulation &a, &b;
  static bool same(double one, double other) {
    return one == other || (std::isnan(one) && std::isnan(other));
  }
  static bool same(const std::string& one, const std::string& other) { return one == other; }
  static bool same(const std::vector<std::string>& one, const std::vector<std::string>& other) {
    return one == other;
  }
  template <class Derived>
  static bool same(const Eigen::DenseBase<Derived>& one, const Eigen::DenseBase<Derived>& other) {
    if (one.rows() != other.rows() || one.cols() != other.cols()) return false;
    for (Index i = 0; i < one.rows(); ++i) {
      for (Index j = 0; j < one.cols(); ++j) {
        if (!same(one.derived()(i, j), other.derived()(i, j))) return false;
      }
    }
    return true;
  }
  static bool same(const std::vector<Array2>& one, const std::vector<Array2>& other) {
    if (one.size() != other.size()) return false;
    for (std::size_t i = 0; i < one.size(); ++i) {
      if (!same(one[i], other[i])) return false;
    }
    return true;
  }
  bool operator()(auto member) const { return !same(a.*member, b.*member); }
};

std::string first_difference(const Simulation& a, const Simulation& b) {
  for (const SimulationVariable& variable : simulation_variables()) {
    if (std::visit(Differs{a, b}, variable.member)) return variable.name;
  }
  return "";
}

TEST(SimulationFile, ComesBackBitByBit) {
  const TemporaryFolder folder;
  const Simulation written = example_simulation(test_support::example_measurement(), 0, 2);
  const fs::path file = write_simulation(folder.path(), written);
  EXPECT_EQ(first_difference(read_simulation(file), written), "");
  Simulation other = written;
  other.pressure(1, 3) += 1.0;
  EXPECT_EQ(first_difference(other, written), "pressure");
}

TEST(SimulationFile, ASecondOneOfARunReplacesItsOwnOnly) {
  const TemporaryFolder folder;
  const Measurement measurement = test_support::example_measurement();
  write_result(folder / "result", measurement, {{"report.html", "page"}});
  const std::string before = read_file(folder / "result/result.nc");
  for (const Index run : {0, 1}) {
    for (const int dim : {2, 3}) {
      write_simulation(folder / "result", example_simulation(measurement, run, dim));
    }
  }
  Simulation again = example_simulation(measurement, 1, 2);
  again.seconds = 99.0;
  write_simulation(folder / "result", again);
  const StoredSimulations stored = read_simulations(folder / "result", measurement);
  ASSERT_EQ(stored.simulations.size(), 4u);
  EXPECT_TRUE(stored.left_out.empty());
  int replaced = 0;
  for (const Simulation& one : stored.simulations) {
    const bool is_again = one.run == again.run && one.dim == 2.0;
    replaced += is_again ? 1 : 0;
    EXPECT_EQ(one.seconds == 99.0, is_again);
  }
  EXPECT_EQ(replaced, 1);
  EXPECT_EQ(read_file(folder / "result/result.nc"), before);
  EXPECT_EQ(read_file(folder / "result/report.html"), "page");
  // A result that is written again leaves them where they are.
  write_result(folder / "result", measurement, {{"report.html", "page"}});
  EXPECT_EQ(read_simulations(folder / "result", measurement).simulations.size(), 4u);
}

TEST(SimulationFile, ThatIsDamagedIsRefusedByName) {
  const TemporaryFolder folder;
  const Measurement measurement = test_support::example_measurement();
  const fs::path file = write_simulation(folder.path(), example_simulation(measurement, 0, 2));
  const std::string whole = read_file(file);
  for (const std::size_t length : {std::size_t{0}, std::size_t{100}, whole.size() / 2}) {
    std::ofstream(file, std::ios::binary | std::ios::trunc).write(whole.data(), length);
    try {
      read_simulations(folder.path(), measurement);
      FAIL() << "read " << length << " bytes of " << whole.size();
    } catch (const InputError& error) {
      EXPECT_EQ(error.where(), file.string());
    }
  }
  // A NetCDF file of something else.
  write_result(folder / "other", measurement, {});
  fs::copy_file(folder / "other/result.nc", file, fs::copy_options::overwrite_existing);
  try {
    read_simulations(folder.path(), measurement);
    FAIL() << "took a result for a simulation";
  } catch (const InputError& error) {
    EXPECT_EQ(error.where(), file.string());
    EXPECT_NE(std::string(error.what()).find("simulate"), std::string::npos);
  }
}

TEST(SimulationFile, OfOtherMapsOrAnotherReadingIsLeftOut) {
  const TemporaryFolder folder;
  const Measurement measurement = test_support::example_measurement();
  write_simulation(folder.path(), example_simulation(measurement, 0, 2));
  Measurement other = measurement;
  other.inputs += "one more  map\n";
  EXPECT_TRUE(read_simulations(folder.path(), other).simulations.empty());
  EXPECT_EQ(read_simulations(folder.path(), other).left_out.size(), 1u);
  other = measurement;
  other.extracted_drop[0] *= 1.001;
  EXPECT_TRUE(read_simulations(folder.path(), other).simulations.empty());
  EXPECT_NE(read_simulations(folder.path(), other).left_out[0].find("other settings"),
            std::string::npos);
  EXPECT_TRUE(read_simulations(folder / "nowhere", measurement).simulations.empty());
}

TEST(SimulationFile, NamesAreSafeAndTellRunsApart) {
  EXPECT_EQ(simulation_file("Q70", 2), fs::path("simulation/Q70_2d.nc"));
  EXPECT_EQ(simulation_file("../up and/away", 3),
            fs::path("simulation/%2E.%2Fup%20and%2Faway_3d.nc"));
  EXPECT_NE(simulation_file("a/b", 2), simulation_file("a%2Fb", 2));
}

TEST(SimulationFile, IsNotWrittenWhereItCannotBe) {
  const TemporaryFolder folder;
  const Measurement measurement = test_support::example_measurement();
  const fs::path file = write_simulation(folder.path(), example_simulation(measurement, 0, 2));
  const std::string before = read_file(file);
  ASSERT_EQ(::chmod(file.parent_path().c_str(), 0555), 0);
  {
    const test_support::AsOrdinaryUser ordinary;
    if (!ordinary.holds()) GTEST_SKIP() << "permissions do not bind here";
    EXPECT_THROW(write_simulation(folder.path(), example_simulation(measurement, 0, 2)),
                 InputError);
  }
  ASSERT_EQ(::chmod(file.parent_path().c_str(), 0755), 0);
  EXPECT_EQ(read_file(file), before);
}

TEST(SimulationFile, BelongsToAResultOfTheSameMaps) {
  const TemporaryFolder folder;
  const Measurement measurement = test_support::example_measurement();
  EXPECT_THROW(check_result_of(folder / "none", measurement.experiment, measurement.inputs),
               InputError);
  write_result(folder / "result", measurement, {});
  check_result_of(folder / "result", measurement.experiment, measurement.inputs);
  EXPECT_THROW(check_result_of(folder / "result", "name = \"other\"", measurement.inputs),
               InputError);
  EXPECT_THROW(check_result_of(folder / "result", measurement.experiment, "a  b\n"), InputError);
}

TEST(SimulationFile, OfThePassagesStandsBesideAResultOfTheirExperiment) {
  const TemporaryFolder folder;
  const Measurement measurement = test_support::example_measurement();
  EXPECT_THROW(check_result_of(folder / "none", measurement.experiment), InputError);
  write_result(folder / "result", measurement, {});
  EXPECT_THROW(check_result_of(folder / "result", "name = \"other\""), InputError);
  check_result_of(folder / "result", measurement.experiment);
  const fs::path file = write_passages(folder / "result", "table\n");
  EXPECT_EQ(file, folder / "result" / "simulation" / "passages.csv");
  EXPECT_EQ(read_file(file), "table\n");
  EXPECT_TRUE(read_simulations(folder / "result", measurement).simulations.empty());
}

TEST(SimulationTable, HasARowAStationAndEmptyCellsForWhatIsNotThere) {
  const Measurement measurement = test_support::example_measurement();
  Simulation plane = example_simulation(measurement, 0, 2);
  plane.run = "a, \"b\"";
  const std::string text = simulations_table({plane, example_simulation(measurement, 1, 3)});
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1 + 2 * plane.x.size());
  EXPECT_NE(text.find("\n\"a, \"\"b\"\"\",2,"), std::string::npos);
  EXPECT_NE(text.find(",uncertainty_by_channel_height_Pa\n"), std::string::npos);
  const std::size_t columns = static_cast<std::size_t>(
      std::count(text.begin(), text.begin() + static_cast<Index>(text.find('\n')), ','));
  const std::size_t last = text.rfind('\n', text.size() - 2) + 1;
  const std::string row = text.substr(last);
  EXPECT_EQ(static_cast<std::size_t>(std::count(row.begin(), row.end(), ',')), columns);
  EXPECT_NE(row.find(",,,"), std::string::npos);  // no side walls to add, nothing read there
  EXPECT_EQ(simulations_table({}), "");
}

TEST(SimulationFile, IsDescribedInTheManual) {
  const std::string page = read_file(fs::path(test_paths::source) / "docs/result-file.md");
  EXPECT_NE(page.find(simulation_schema_as_markdown()), std::string::npos)
      << "docs/result-file.md must hold this table:\n"
      << simulation_schema_as_markdown();
}

}  // namespace
}  // namespace manoscope::results
