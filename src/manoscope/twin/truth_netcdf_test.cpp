#include "manoscope/twin/truth_netcdf.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "manoscope/core/error.hpp"
#include "manoscope/io/netcdf_handle.hpp"
#include "manoscope/twin/virtual_experiment.hpp"
#include "tests/support/temporary_folder.hpp"

namespace manoscope::twin {
namespace {

VirtualExperiment tiny() {
  Scenario scenario = small_s1();
  scenario.camera.n_along = 48;
  scenario.camera.n_across = 16;
  scenario.solver.steps = 400;
  return make_virtual_experiment(scenario, 3);
}

void write(const std::filesystem::path& path, const VirtualExperiment& made) {
  write_truth_netcdf(path, made.truth, made.scalars, made.header);
}

bool same(const SnapTruth& a, const SnapTruth& b) {
  return a.n == b.n && a.jump == b.jump && a.at == b.at;
}

std::string content(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST(TruthNetcdf, ComesBackBitForBit) {
  const test_support::TemporaryFolder folder;
  VirtualExperiment made = tiny();
  made.truth.levels[5].snaps = {3, -1.25e-6, 4.5e-3};
  made.truth.runs[1].snaps = {1, 2.5e-6, 7.75e-3};
  write(folder.path() / "truth.nc", made);
  const Truth read = read_truth(folder.path());
  EXPECT_TRUE((read.x == made.truth.x).all());
  ASSERT_EQ(read.runs.size(), 4u);
  ASSERT_EQ(read.levels.size(), 17u);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(read.runs[i].run, made.truth.runs[i].run);
    EXPECT_TRUE((read.runs[i].pressure == made.truth.runs[i].pressure).all());
    EXPECT_TRUE((read.runs[i].deflection == made.truth.runs[i].deflection).all());
    EXPECT_TRUE(same(read.runs[i].snaps, made.truth.runs[i].snaps)) << i;
  }
  for (std::size_t i = 0; i < 17; ++i) {
    EXPECT_EQ(read.levels[i].map, made.truth.levels[i].map);
    EXPECT_EQ(read.levels[i].label, made.truth.levels[i].label);
    EXPECT_TRUE(same(read.levels[i].snaps, made.truth.levels[i].snaps)) << i;
    EXPECT_EQ(read.levels[i].pressure, made.truth.levels[i].pressure);
    EXPECT_TRUE((read.levels[i].deflection == made.truth.levels[i].deflection).all());
    ASSERT_EQ(read.levels[i].compliance.size(), read.x.size());
    EXPECT_TRUE((read.levels[i].compliance == made.truth.levels[i].compliance).all());
  }
}

TEST(TruthNetcdf, LeavesOutAComplianceThatOneLevelLacks) {
  const test_support::TemporaryFolder folder;
  VirtualExperiment made = tiny();
  made.truth.levels[3].compliance.resize(0);
  write(folder.path() / "truth.nc", made);
  for (const LevelTruth& level : read_truth(folder.path()).levels) {
    EXPECT_EQ(level.compliance.size(), 0);
  }
}

TEST(TruthNetcdf, TheSameTruthGivesTheSameBytes) {
  const test_support::TemporaryFolder folder;
  const VirtualExperiment made = tiny();
  write(folder.path() / "a.nc", made);
  write(folder.path() / "b.nc", made);
  EXPECT_EQ(content(folder.path() / "a.nc"), content(folder.path() / "b.nc"));
}

TEST(TruthNetcdf, EveryVariableHasUnitAndMeaning) {
  const test_support::TemporaryFolder folder;
  write(folder.path() / "truth.nc", tiny());
  const auto file = io::NetcdfFile::open(folder.path() / "truth.nc");
  for (const auto& variable : file.variables()) {
    EXPECT_TRUE(file.text_attribute(variable.id, "long_name")) << variable.name;
    if (variable.numeric) {
      EXPECT_TRUE(file.text_attribute(variable.id, "units")) << variable.name;
    }
  }
  EXPECT_EQ(file.text_attribute(io::NetcdfFile::kGlobal, "seed"), "3");
  EXPECT_EQ(file.read_doubles(*file.variable("channel_height")).front(), 175e-6);
}

TEST(TruthNetcdf, NamesTheModelOfItsFlowUnlessThatIsTheRectangle) {
  const test_support::TemporaryFolder folder;
  VirtualExperiment made = tiny();
  const auto told = [&](const char* name) {
    write(folder.path() / "truth.nc", made);
    return io::NetcdfFile::open(folder.path() / "truth.nc")
        .text_attribute(io::NetcdfFile::kGlobal, name);
  };
  EXPECT_EQ(told("flow_model"), std::nullopt);
  Scenario scenario = small_s1();
  scenario.levels = {Pressure{}};
  scenario.flow_rates = {5.0 * mL_per_min};
  scenario.camera.n_along = scenario.camera.n_across = 16;
  scenario.solver = {};
  scenario.solver.flow_model = "plane-march";
  scenario.solver.inlet_profile = "uniform";
  made = make_virtual_experiment(scenario, 3);
  EXPECT_EQ(told("flow_model"), "plane-march");
  EXPECT_EQ(told("inlet_profile"), "uniform");
}

TEST(TruthNetcdf, AFileThatLacksSomethingIsNamed) {
  const test_support::TemporaryFolder folder;
  const auto path = folder.path() / "truth.nc";
  {
    auto file = io::NetcdfFile::create(path);
    const int x = file.define_dimension("x", 2);
    const double values[] = {1.0, 1.0};
    file.write(file.define_double("x", {x}), values);
    file.close();
  }
  try {
    read_truth(path);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.where(), path.string());
    EXPECT_EQ(error.found(), "x does not grow");
  }
  std::ofstream(path) << "no such thing";
  EXPECT_THROW(read_truth(path), InputError);
}

}  // namespace
}  // namespace manoscope::twin
