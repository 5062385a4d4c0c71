#include "manoscope/pipeline/checks.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "manoscope/numerics/robust.hpp"
#include "manoscope/pipeline/test_experiment.hpp"

namespace manoscope::pipeline {
namespace {

using results::Measurement;

/// The virtual experiment with the run of 20 mL/min twice more in the same run and once more in
/// another, with errors of their own.
class Repeated : public TestExperiment {
 public:
  /// @param factor  of the deflection of the repeats under flow.
  explicit Repeated(double factor = 1.0) {
    const auto solved = twin::solve_scenario(scenario);
    const Array1 x = twin::ChannelCurve::nodes(scenario.channel.length, 600);
    const twin::ChannelCurve deflection(scenario.channel.length,
                                        factor * solved.runs[0].flow.deflection(x));
    for (const char* name : {"r0.gsf", "r1.gsf", "r2.gsf"}) {
      add_map(name, deflection, twin.maps.size());
    }
    twin.flow_csv =
        "map,flow_rate [mL/min],run\nf00.gsf,20,Q20\nf01.gsf,70,Q70\n"
        "r0.gsf,20,Q20\nr1.gsf,20,Q20\nr2.gsf,20,again\n";
  }
};

TEST(StoreRepeats, ComparesMapsOfOneFlowRateInOneRunAndInSeveral) {
  Repeated test;
  const Measurement m = test.measure();
  ASSERT_EQ(m.repeat.size(), 1u);
  EXPECT_EQ(m.repeat[0], "flow 20 mL/min");
  EXPECT_EQ(m.repeat_maps[0], 4);
  EXPECT_EQ(m.repeat_dof[0], 6.0);
  // Noise of the pixels and of the rim's plane: a pascal or two.
  EXPECT_LT(m.repeat_scatter[0], 5.0);
  EXPECT_GT(m.repeat_p_value[0], 1e-3);
  EXPECT_FALSE(warns_of(m, "did not stand still")) << all_warnings(m);
}

TEST(StoreRepeats, TellsAFlowThatDidNotStandStill) {
  Repeated test(1.03);  // 3 % of zeta are 9 % of p where the wall stretches
  const Measurement m = test.measure();
  ASSERT_EQ(m.repeat.size(), 1u);
  EXPECT_LT(m.repeat_p_value[0], 1e-6);
  EXPECT_GT(m.repeat_scatter[0], 30.0);
  EXPECT_TRUE(warns_of(m, "The 4 maps of flow 20 mL/min scatter by")) << all_warnings(m);
}

TEST(StoreRepeats, ComparesMapsOfOneLevel) {
  twin::Scenario scenario = small_scenario();
  scenario.levels.insert(scenario.levels.begin() + 9, scenario.levels[9]);
  TestExperiment test(scenario);
  // One label for both maps.
  auto& levels = test.twin.truth.levels;
  levels[10].label = levels[9].label;
  test.twin.hydrostatic_csv = twin::hydrostatic_csv(scenario, levels);
  const Measurement m = test.measure();
  ASSERT_EQ(m.repeat.size(), 1u) << all_warnings(m);
  EXPECT_EQ(m.repeat[0].substr(0, 6), "level ");
  EXPECT_EQ(m.repeat_dof[0], 2.0);
  // Both maps stand under the same pressure; each label could be off by 10 Pa.
  EXPECT_LT(m.repeat_scatter[0], 8.0);
  EXPECT_GT(m.repeat_p_value[0], 0.05);
}

/// Levels listed up and down again, every second one on the way down; their labels higher by `lag`.
std::string up_and_down(const twin::Scenario& scenario, const twin::VirtualExperiment& made,
                        Pressure lag) {
  std::vector<twin::LevelTruth> up, down;
  for (std::size_t k = 0; k < made.truth.levels.size(); ++k) {
    (k % 2 == 0 ? up : down).push_back(made.truth.levels[k]);
  }
  for (auto level = down.rbegin(); level != down.rend(); ++level) {
    level->label = level->label + lag;
    up.push_back(*level);
  }
  return twin::hydrostatic_csv(scenario, up);
}

TEST(StoreSweeps, TellsAWallThatDiffersOnTheWayDown) {
  TestExperiment test;
  const Measurement one_way = test.measure();
  EXPECT_EQ(one_way.sweep_down_maps, 0.0);
  EXPECT_TRUE(std::isnan(one_way.sweep_difference));
  for (const Pressure lag : {Pressure{}, 100.0 * Pa}) {
    test.twin.hydrostatic_csv = up_and_down(test.scenario, test.twin, lag);
    const Measurement m = test.measure();
    EXPECT_GE(m.sweep_down_maps, 5.0);
    EXPECT_NEAR(m.sweep_difference, lag.si(), 4.0 * m.sweep_difference_uncertainty);
    // Labels of 10 Pa on both ways, and curves through half of the levels.
    EXPECT_LT(m.sweep_difference_uncertainty, 20.0);
    EXPECT_EQ(warns_of(m, "on the way down"), lag > Pressure{}) << all_warnings(m);
  }
}

TEST(StoreLeftOut, HasPullsOfAboutUnitWidthButWhereTheWallTurns) {
  std::vector<double> pulls;
  for (const std::uint64_t seed : {1, 2, 3}) {
    TestExperiment test(small_scenario(), seed);
    const Measurement m = test.measure();
    ASSERT_EQ(m.left_out_mean_error.size(), m.level_pressure.size());
    EXPECT_TRUE(std::isnan(m.left_out_mean_error[0]));
    for (Index k = 1; k + 1 < m.level_pressure.size(); ++k) {
      ASSERT_TRUE(std::isfinite(m.left_out_mean_error[k])) << k;
      EXPECT_GE(m.left_out_mean_uncertainty[k], m.level_pressure_uncertainty[k]);
      pulls.push_back(std::abs(m.left_out_mean_error[k]) / m.left_out_mean_uncertainty[k]);
    }
  }
  // The wall is bowed at rest: one level in fifteen, left out, takes the turn of the curves with
  // it. The median of 45 pulls of a normal law is 0.67, 3 sigma of it 0.35; neighbours hang
  // together.
  EXPECT_NEAR(numerics::median(pulls), 0.67, 0.4);
}

TEST(StoreRuns, BudgetOfTheDropAddsUpToItsUncertainty) {
  TestExperiment test;
  const Measurement m = test.measure();
  ASSERT_EQ(m.extracted_drop_variance.rows(), static_cast<Index>(m.budget_source.size()));
  for (Index r = 0; r < m.flow_rate.size(); ++r) {
    const double sum = m.extracted_drop_variance.col(r).sum();
    EXPECT_NEAR(sum / std::pow(m.extracted_drop_uncertainty[r], 2), 1.0, 1e-12);  // round-off
  }
}

TEST(DoubtShapes, NamesFourMapsInFullAndTheRestInOneLine) {
  Measurement m;
  experiment::Experiment experiment;
  constexpr Index kMaps = 6;
  experiment.hydrostatic.resize(2);
  experiment.hydrostatic[1].pressure = 900.0 * Pa;
  m.x = Array1::LinSpaced(20, 0.0, 10e-3);
  m.section_x = Array1::LinSpaced(10, 0.5e-3, 9.5e-3);
  m.flow_rate = Array1::Ones(1);
  m.run = {"Q5"};
  m.pressure_uncertainty = Array2::Constant(1, 20, 4.0);
  m.shape_dof = Array2::Constant(kMaps, 10, 11.0);
  m.shape_chi_square = 3.0 * m.shape_dof;
  m.shape_p_value = Array1::Constant(kMaps, 1e-9);
  m.shape_reading_shift = Array1::Constant(kMaps, 20.0);
  m.shape_worst = Array2(kMaps, 2);
  for (Index i = 0; i < kMaps; ++i) {
    m.map.push_back("m" + std::to_string(i));
    m.map_run.push_back(i < 2 ? -1 : 0);
    m.shape_worst.row(i) << 4e-3, 5e-3;
  }
  const auto doubts = doubt_shapes(experiment, m);
  ASSERT_EQ(doubts.size(), 5u);
  EXPECT_NE(doubts[1].find("Level 900 Pa (m1)"), std::string::npos) << doubts[1];
  EXPECT_NE(doubts[1].find("of runs that pass this level may be off there by 20 Pa"),
            std::string::npos)
      << doubts[1];
  EXPECT_NE(doubts[2].find("Run Q5 (m2): between x = 4.00 and 5.00 mm"), std::string::npos);
  EXPECT_NE(doubts[2].find("chi-square 3.0 times"), std::string::npos) << doubts[2];
  EXPECT_NE(doubts[2].find("5.0 times its standard uncertainty"), std::string::npos) << doubts[2];
  EXPECT_NE(doubts[4].find("m4, m5"), std::string::npos) << doubts[4];
  // By chance, or too little to matter: not told.
  m.shape_p_value.setConstant(1e-3);
  EXPECT_TRUE(doubt_shapes(experiment, m).empty());
  m.shape_p_value.setConstant(1e-9);
  m.shape_reading_shift.setConstant(7.9);
  EXPECT_TRUE(doubt_shapes(experiment, m).empty());
}

}  // namespace
}  // namespace manoscope::pipeline
