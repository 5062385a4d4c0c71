// Cross-sections of clamped walls after Foeppl and von Karman under flow: they are bent by pressure
// alone, and by neighbours under other pressure.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "manoscope/pipeline/checks.hpp"
#include "manoscope/pipeline/test_experiment.hpp"
#include "manoscope/twin/scenario_file.hpp"

namespace manoscope::pipeline {
namespace {

using results::Measurement;

/// A shipped scenario through a small camera, at three of its flow rates; its wall on few cells.
/// Patches of a false fringe order are foreign deformations: without them.
twin::Scenario scenario_of(const std::string& name) {
  twin::Scenario scenario = twin::find_scenario(name);
  scenario.camera.n_along = 512;
  scenario.camera.n_across = 96;
  scenario.camera.fringe_jumps = 0.0;
  scenario.wall_grid = {20, 8};
  const auto rates = scenario.flow_rates;
  scenario.flow_rates = {rates[1], rates[4], rates[8]};
  return scenario;
}

/// The wall of each scenario, solved once.
const twin::SolvedScenario& solved(const std::string& name) {
  static std::map<std::string, twin::SolvedScenario> walls;
  const auto found = walls.find(name);
  if (found != walls.end()) return found->second;
  return walls.emplace(name, twin::solve_scenario(scenario_of(name))).first->second;
}

TestExperiment seen(const std::string& name, std::uint64_t seed) {
  const twin::Scenario scenario = scenario_of(name);
  return TestExperiment(scenario, twin::record_experiment(scenario, solved(name), seed));
}

/// Adds a bump, Gaussian of 0.12 mm, a quarter of the width off the middle.
void plant(TestExperiment& test, const std::string& map, double x, double height) {
  HeightMap& old = test.map(map);
  const CameraGrid& grid = old.grid();
  const double rim = test.scenario.camera.rim.si(), width = test.scenario.channel.width.si();
  Array2 heights = old.height();
  for (Index iy = 0; iy < grid.ny; ++iy) {
    for (Index ix = 0; ix < grid.nx; ++ix) {
      const double dx = (static_cast<double>(ix) + 0.5) * grid.pitch_x.si() - rim - x;
      const double dz = (static_cast<double>(iy) + 0.5) * grid.pitch_y.si() - rim - 0.75 * width;
      heights(iy, ix) += height * std::exp(-0.5 * (dx * dx + dz * dz) / std::pow(0.12e-3, 2));
    }
  }
  old = HeightMap(grid, heights, old.flags());
}

class Walls : public ::testing::TestWithParam<const char*> {};

TEST_P(Walls, AreSeldomBlamedForTheirNeighboursPressure) {
  constexpr int kSeeds = 3;
  int n_maps = 0, n_blamed = 0;
  double chi_square = 0.0;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    TestExperiment test = seen(GetParam(), seed);
    const Measurement m = test.measure();
    EXPECT_FALSE(warns_of(m, "cross-section")) << all_warnings(m);
    for (Index i = 0; i < m.shape_p_value.size(); ++i) {
      if (m.map_run[static_cast<std::size_t>(i)] < 0) continue;
      ++n_maps;
      n_blamed += m.shape_p_value[i] < 0.05;
      chi_square += m.shape_reduced_chi_square[i];
      EXPECT_GT(m.shape_p_value[i], 1e-4) << m.map[static_cast<std::size_t>(i)] << ' ' << seed;
    }
  }
  ASSERT_EQ(n_maps, 3 * kSeeds);
  // 0.45 of 9; 4 and more once in a thousand.
  EXPECT_LE(n_blamed, 3);
  // Some 570 degrees of freedom a map; what is allowed for the neighbours is not always used up.
  EXPECT_NEAR(chi_square / n_maps, 1.0, 0.06);
}

TEST_P(Walls, ShowABumpOnTheMapUnderFlow) {
  TestExperiment test = seen(GetParam(), 5);
  plant(test, "f01.gsf", 6e-3, 200e-9);
  const Measurement m = test.measure();
  const auto at = std::find(m.map.begin(), m.map.end(), "f01.gsf") - m.map.begin();
  EXPECT_LT(m.shape_p_value[at], 1e-12);
  // To a stretch, 0.2 mm, and what of the bump stands out of the noise: three of its deviations.
  EXPECT_NEAR(0.5 * (m.shape_worst(at, 0) + m.shape_worst(at, 1)), 6e-3, 0.2e-3);
  EXPECT_LT(m.shape_worst(at, 1) - m.shape_worst(at, 0), 1.1e-3);
  for (Index i = 0; i < m.shape_p_value.size(); ++i) {
    if (i == at || m.map_run[static_cast<std::size_t>(i)] < 0) continue;
    EXPECT_GT(m.shape_p_value[i], 1e-4) << m.map[static_cast<std::size_t>(i)];
  }
}

INSTANTIATE_TEST_SUITE_P(OfTheKindOf, Walls, ::testing::Values("S1", "S4", "S5"));

TEST(Shapes, OfABumpThatMattersAreTold) {
  // On the stiffest wall: 0.3 mm of 200 nm are 30 nm of the average.
  TestExperiment test = seen("S1", 5);
  plant(test, "f02.gsf", 6e-3, 400e-9);
  const Measurement m = test.measure();
  ASSERT_TRUE(warns_of(m, "f02.gsf")) << all_warnings(m);
  EXPECT_TRUE(warns_of(m, "mm the wall has not the cross-section that pressure gives it"));
  EXPECT_TRUE(warns_of(m, "times its standard uncertainty"));
  // Against the same map without the bump: what it did to the local reading.
  TestExperiment clean = seen("S1", 5);
  const Measurement without = clean.measure();
  EXPECT_FALSE(warns_of(without, "cross-section")) << all_warnings(without);
  double moved = 0.0;
  for (Index ix = 0; ix < m.x.size(); ++ix) {
    if (m.x[ix] < 5.8e-3 || m.x[ix] > 6.2e-3) continue;
    moved = std::max(moved, std::abs(m.pressure_local(2, ix) - without.pressure_local(2, ix)));
  }
  // "May be off by": not below what it is by much, nor far above.
  EXPECT_GT(m.shape_reading_shift[26], 0.6 * moved);
  EXPECT_LT(m.shape_reading_shift[26], 3.0 * moved);
}

TEST(Shapes, OfALevelWithABumpBlameTheLevelAlone) {
  TestExperiment test = seen("S4", 5);
  plant(test, "h15.gsf", 9e-3, 400e-9);
  const Measurement m = test.measure();
  for (Index i = 0; i < m.shape_p_value.size(); ++i) {
    const std::string& map = m.map[static_cast<std::size_t>(i)];
    if (map == "h15.gsf") {
      EXPECT_LT(m.shape_p_value[i], 1e-12);
    } else if (std::isfinite(m.shape_p_value[i])) {
      EXPECT_GT(m.shape_p_value[i], 1e-6) << map;
    }
  }
}

TEST(Shapes, AreNotJudgedWithFewPixelsAcross) {
  twin::Scenario scenario = small_scenario();
  scenario.camera.n_across = 32;
  scenario.camera.blobs = 0.0;
  TestExperiment test(scenario);
  const Measurement m = test.measure();
  EXPECT_EQ(m.section_x.size(), 0);
  EXPECT_TRUE(m.shape_p_value.isNaN().all());
}

}  // namespace
}  // namespace manoscope::pipeline
