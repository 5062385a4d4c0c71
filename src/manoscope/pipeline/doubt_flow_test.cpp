// What is said and stored of a run whose march broke down, and of drops that are far apart.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "manoscope/pipeline/assemble.hpp"

namespace manoscope::pipeline {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

FlowRun run_named(const char* name) {
  FlowRun run;
  run.name = name;
  run.flow_rate = 50.0 * mL_per_min;
  return run;
}

/// A run with a test section of three stations, held against every model.
RunFindings compared(double march_drop) {
  RunFindings found;
  found.reading.x = Array1{{1e-3, 2e-3, 3e-3}};
  found.reading.pressure = Array1{{300.0, 200.0, 100.0}};
  found.reading.flags = Flags1::Zero(3);
  found.section = inversion::TestSection{0, 2};
  validation::ModelComparison comparison;
  for (const flow::FlowModelInfo& info : flow::kFlowModels) {
    const bool march = info.model == flow::FlowModel::section_march;
    validation::ModelAgreement one;
    one.model = info.model;
    one.drop.value = march ? march_drop : 200.0;
    one.agreement = std::isfinite(one.drop.value) ? validation::Agreement::agree
                                                  : validation::Agreement::no_verdict;
    if (std::isfinite(one.drop.value)) {
      one.drop.terms.push_back({"channel height", "channel height", 3.0});
      one.uncertainty = 4.0;
    }
    comparison.models.push_back(one);
  }
  comparison.corrections = {{"mean-gap rectangle", 210.0 * Pa, 300.0 * Pa, std::nullopt},
                            {"entry", Pressure{}, Pressure{}, 5.0 * Pa},
                            {"section march", Pressure::from_si(march_drop - 210.0),
                             Pressure::from_si(kNan), std::nullopt}};
  found.flow.comparison = comparison;
  return found;
}

TEST(BrokenMarch, LeavesNoNumberBehind) {
  results::FlowChecks checks;
  store_flow(std::nullopt, {}, {run_named("Q50")}, {compared(kNan)}, checks);
  ASSERT_EQ(checks.flow_model.back(), "section-march");
  const Index march = checks.model_drop.rows() - 1;
  for (const Array2* table :
       {&checks.model_drop, &checks.model_drop_uncertainty, &checks.model_difference_uncertainty}) {
    EXPECT_TRUE(std::isnan((*table)(march, 0)));
    EXPECT_GT((*table)(0, 0), 0.0);
  }
  EXPECT_TRUE(std::isnan(checks.correction_drop(2, 0)));
  EXPECT_TRUE(std::isnan(checks.correction_uncertainty(2, 0)));
}

TEST(Corrections, HaveAnUncertaintyOnlyWhereOneIsFormed) {
  results::FlowChecks checks;
  store_flow(std::nullopt, {}, {run_named("Q50")}, {compared(190.0)}, checks);
  EXPECT_TRUE(std::isnan(checks.correction_uncertainty(0, 0)));
  EXPECT_EQ(checks.correction_uncertainty(1, 0), 5.0);
  EXPECT_TRUE(std::isnan(checks.correction_uncertainty(2, 0)));
}

TEST(BrokenMarch, IsToldInWords) {
  const std::vector<std::string> doubts = doubt_flow({}, run_named("Q50"), compared(kNan));
  ASSERT_EQ(doubts.size(), 1U);
  EXPECT_EQ(
      doubts[0],
      "Run Q50: the section-march broke down: no drop by it, no total of what all effects add "
      "to the drop, and the run has no say in which flow model is taken");
  EXPECT_TRUE(doubt_flow({}, run_named("Q50"), compared(190.0)).empty());
}

TEST(BrokenMarch, IsNamedWhereTheModelIsChosen) {
  const ChosenModel chosen = choose_model({compared(kNan), compared(190.0)}, {});
  EXPECT_EQ(chosen.words,
            "section-march; 1 of 2 runs had no say in it, since a march broke down there");
  EXPECT_EQ(choose_model({compared(190.0)}, {}).words, "section-march");
}

RunFindings apart(double extracted, double resistance, double bar) {
  RunFindings found;
  found.agreement.emplace();
  found.agreement->extracted.value = extracted;
  found.agreement->resistance.value = resistance;
  found.agreement->en_number = std::abs(extracted - resistance) / bar;
  return found;
}

TEST(DoubtFlow, LeavesRoomForAGapThatIsNotKnown) {
  experiment::Experiment experiment;
  experiment.channel.height = 200.0 * um;
  experiment.channel.width = 1.7 * mm;
  const auto doubts = [&](double extracted) {
    return doubt_flow(experiment, run_named("Q50"), apart(extracted, 1000.0, 2.0));
  };
  EXPECT_TRUE(doubts(1100.0).empty());  // 10 %: a gap 3 % off
  ASSERT_EQ(doubts(2000.0).size(), 1U);
  EXPECT_NE(doubts(2000.0)[0].find("which is not stated, left out"), std::string::npos);
  experiment.channel.height_uncertainty = 0.5 * um;
  EXPECT_EQ(doubts(1100.0).size(), 1U);
}

}  // namespace
}  // namespace manoscope::pipeline
