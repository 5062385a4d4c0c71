#include "manoscope/twin/experiment_files.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "manoscope/core/error.hpp"
#include "manoscope/core/provenance.hpp"
#include "manoscope/io/csv_table.hpp"
#include "manoscope/io/reader.hpp"
#include "tests/support/as_ordinary_user.hpp"

namespace manoscope::twin {
namespace {

namespace fs = std::filesystem;

class ExperimentFolder : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(::testing::TempDir()) /
              (std::string("twin_test_") +
               ::testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::remove_all(folder_);
    scenario_.camera.n_along = 64;
    scenario_.camera.n_across = 32;
    scenario_.solver.steps = 400;
  }
  void TearDown() override {
    std::error_code ignored;
    fs::permissions(folder_, fs::perms::owner_all, ignored);
    fs::remove_all(folder_);
  }

  static std::string content(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }

  fs::path folder_;
  Scenario scenario_ = small_s1();
};

TEST_F(ExperimentFolder, HoldsEveryFileThatItsListsName) {
  const VirtualExperiment experiment = make_virtual_experiment(scenario_, 1);
  write_experiment(folder_, experiment);
  EXPECT_EQ(content(folder_ / "experiment.toml"), experiment.experiment_toml);
  const io::CsvTable levels = io::read_csv_table(folder_ / "hydrostatic.csv");
  ASSERT_EQ(levels.rows.size(), 17u);
  EXPECT_EQ(levels.columns[1].unit, "Pa");
  const io::CsvTable runs = io::read_csv_table(folder_ / "flow.csv");
  ASSERT_EQ(runs.rows.size(), 4u);
  for (const io::CsvTable* table : {&levels, &runs}) {
    for (const io::CsvRow& row : table->rows) EXPECT_TRUE(fs::exists(folder_ / row.cells[0]));
  }
  const Truth truth = read_truth(folder_);
  ASSERT_EQ(truth.runs.size(), 4u);
  EXPECT_EQ(truth.runs[3].run, runs.rows[3].cells[3]);
  const io::CsvTable scalars = io::read_csv_table(folder_ / "truth/truth_scalars.csv");
  EXPECT_EQ(scalars.rows.size(), 4u);
  EXPECT_EQ(io::read_csv_table(folder_ / "truth/truth_levels.csv").rows.size(), 17u);
  EXPECT_EQ(io::read_csv_table(folder_ / "truth/truth_static.csv").columns.size(), 18u);
}

TEST_F(ExperimentFolder, MapsReadBackAsRecorded) {
  const VirtualExperiment experiment = make_virtual_experiment(scenario_, 1);
  write_experiment(folder_, experiment);
  for (const NamedMap& map : experiment.maps) {
    const HeightMap read = io::read_height_map(folder_ / map.name);
    EXPECT_EQ(read.grid().nx, map.map.grid().nx);
    EXPECT_NEAR(read.grid().pitch_x / map.map.grid().pitch_x, 1.0, 1e-12);
    EXPECT_TRUE((read.flags() == map.map.flags()).all());
    // 32-bit floats: 2^-24 of heights up to 80 um is 5 pm.
    EXPECT_LT(((map.map.flags() == 0).cast<double>() * (read.height() - map.map.height()))
                  .abs()
                  .maxCoeff(),
              5e-12);
  }
}

TEST_F(ExperimentFolder, HasTheSameBytesForTheSameSeedOnOneOrTwoThreads) {
  write_experiment(folder_ / "one", make_virtual_experiment(scenario_, 9, 1));
  write_experiment(folder_ / "two", make_virtual_experiment(scenario_, 9, 2));
  int n_files = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder_ / "one")) {
    if (!entry.is_regular_file()) continue;
    const auto other = folder_ / "two" / fs::relative(entry.path(), folder_ / "one");
    EXPECT_EQ(content(entry.path()), content(other)) << other;
    ++n_files;
  }
  EXPECT_EQ(n_files, 21 + 3 + 5);
}

TEST_F(ExperimentFolder, IsNotReplacedUnlessAsked) {
  write_experiment(folder_, make_virtual_experiment(scenario_, 1));
  const std::string before = content(folder_ / "h03.gsf");
  const VirtualExperiment other = make_virtual_experiment(scenario_, 2);
  EXPECT_THROW(write_experiment(folder_, other), InputError);
  EXPECT_EQ(content(folder_ / "h03.gsf"), before);
  write_experiment(folder_, other, true);
  EXPECT_NE(content(folder_ / "h03.gsf"), before);
  EXPECT_EQ(content(folder_ / "experiment.toml"), other.experiment_toml);
}

TEST_F(ExperimentFolder, IsLeftAsItWasByACheckAndByAWriteThatIsStopped) {
  check_destination(folder_ / "deep" / "er");
  EXPECT_FALSE(fs::exists(folder_));
  const VirtualExperiment experiment = make_virtual_experiment(scenario_, 1);
  int asked = 0;
  Monitor stop;
  stop.stop_requested = [&] { return ++asked > 5; };  // at the sixth map
  EXPECT_THROW(write_experiment(folder_ / "new", experiment, false, stop), Interrupted);
  EXPECT_FALSE(fs::exists(folder_));

  write_experiment(folder_, experiment);
  const std::string before = content(folder_ / "h03.gsf");
  asked = 0;
  EXPECT_THROW(write_experiment(folder_, make_virtual_experiment(scenario_, 2), true, stop),
               Interrupted);
  EXPECT_EQ(content(folder_ / "h03.gsf"), before);
  EXPECT_EQ(content(folder_ / "experiment.toml"), experiment.experiment_toml);
  EXPECT_FALSE(fs::exists(folder_ / ".manoscope-twin"));
}

TEST_F(ExperimentFolder, KeepsTheHashOfEveryMapInItsTruth) {
  write_experiment(folder_, make_virtual_experiment(scenario_, 1));
  const Truth truth = read_truth(folder_);
  EXPECT_EQ(truth.name, "S1 (virtual), seed 1");
  for (const char* name : {"h00.gsf", "h16.gsf", "f03.gsf"}) {
    const std::string line = std::string(name) + "  " + sha256(content(folder_ / name)) + "\n";
    EXPECT_NE(truth.inputs.find(line), std::string::npos) << line << truth.inputs;
  }
}

TEST_F(ExperimentFolder, ThatCannotBeMadeIsAClearError) {
  fs::create_directories(folder_);
  std::ofstream(folder_ / "taken") << "a file";
  const VirtualExperiment experiment = make_virtual_experiment(scenario_, 1);
  EXPECT_THROW(write_experiment(folder_ / "taken", experiment), InputError);
}

TEST_F(ExperimentFolder, ThatMayNotBeWrittenToIsAClearErrorAndStaysAsItWas) {
  fs::create_directories(folder_);
  const VirtualExperiment experiment = make_virtual_experiment(scenario_, 1);
  fs::permissions(folder_, fs::perms::owner_read | fs::perms::owner_exec | fs::perms::others_read |
                               fs::perms::others_exec);
  {
    const test_support::AsOrdinaryUser nobody;
    if (!nobody.holds()) GTEST_SKIP() << "cannot act as an ordinary user here";
    for (const fs::path& target : {folder_, folder_ / "new"}) {
      try {
        write_experiment(target, experiment);
        ADD_FAILURE() << "wrote to " << target;
      } catch (const InputError& error) {
        EXPECT_NE(error.where().find(folder_.string()), std::string::npos) << error.where();
      }
    }
  }
  fs::permissions(folder_, fs::perms::owner_all);
  EXPECT_TRUE(fs::is_empty(folder_));
}

TEST(ExperimentToml, StatesEveryValueWithItsUnit) {
  Scenario scenario = small_s1();
  scenario.name = "a \"quoted\" name";
  scenario.camera.flow = FlowDirection::minus_rows;
  scenario.camera.outward = Outward::minus_height;
  scenario.camera.rotation = 0.5 * deg;
  scenario.gauge.gain_uncertainty = 0.002;
  scenario.gauge.zero_uncertainty = 5.0 * Pa;
  const std::string text = experiment_toml(scenario, experiment_name(scenario, 7), 174.48 * um);
  for (const char* line :
       {"manoscope = 1\n",
        "name = \"a \\\"quoted\\\" name, seed 7\"\n",
        "length = \"15.5 mm\"\n",
        "width = \"1.7 mm\"\n",
        "height = \"174.48 um\"\n",
        "height_uncertainty = \"0.5 um\"\n",
        "origin = [\"0.4 mm\", \"15.9 mm\"]\n",
        "flow = \"-rows\"\n",
        "rotation = \"0.5 deg\"\n",
        "outward = \"-height\"\n",
        "thickness = \"200 nm\"\n",
        "youngs_modulus = \"250 GPa\"\n",
        "poisson_ratio = 0.23\n",
        "prestress = \"10 MPa\"\n",
        "viscosity = \"1 mPa s\"\n",
        "density = \"998 kg/m3\"\n",
        "height_noise = \"20 nm\"\n",
        "pressure_noise = \"10 Pa\"\n",
        "pressure_gain_uncertainty = 0.002\n",
        "pressure_zero_uncertainty = \"5 Pa\"\n",
        "list = \"hydrostatic.csv\"\n",
        "list = \"flow.csv\"\n",
        "inlet = {length = \"2 mm\", width = \"1.7 mm\", height = \"250 um\"}\n"}) {
    EXPECT_NE(text.find(line), std::string::npos) << line << "\nin\n" << text;
  }
}

TEST(ExperimentToml, ChoosesTheUnitInWhichANumberIsNotSmall) {
  Scenario scenario = small_s1();
  scenario.wall.youngs_modulus = 1.0 * MPa;
  scenario.wall.prestress = -2.5 * kPa;
  scenario.wall.thickness = 0.1 * mm;
  const auto holds = [&](const char* line) {
    const std::string text = experiment_toml(scenario, "soft", 100.0 * um);
    return text.find(line) != std::string::npos;
  };
  EXPECT_TRUE(holds("youngs_modulus = \"1 MPa\"\n"));
  EXPECT_TRUE(holds("prestress = \"-2.5 kPa\"\n"));
  EXPECT_TRUE(holds("thickness = \"100 um\"\n"));
  scenario.wall.prestress = Pressure{};
  EXPECT_TRUE(holds("prestress = \"0 Pa\"\n"));
  scenario.wall.youngs_modulus = Pressure::from_si(999999.99999999);  // not "1000 kPa"
  EXPECT_TRUE(holds("youngs_modulus = \"1 MPa\"\n"));
}

TEST(RunLabel, IsTheFlowRateInMillilitresAMinute) {
  EXPECT_EQ(run_label(70.0 * mL_per_min), "Q70");
  EXPECT_EQ(run_label(12.5 * mL_per_min), "Q12.5");
}

}  // namespace
}  // namespace manoscope::twin
