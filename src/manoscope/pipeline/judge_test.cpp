#include "manoscope/pipeline/judge.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "manoscope/core/error.hpp"
#include "manoscope/pipeline/test_judged_run.hpp"

namespace manoscope::pipeline {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// With another run in front, a calibration level that the truth knows and one that it does not.
struct Case : test_support::JudgedRunCase {
  Case() {
    truth.runs.insert(truth.runs.begin(), {"other", Array1::Zero(8), Array1::Zero(8)});
    m.channel_length = 10e-3;
    m.level_pressure = Array1(2);
    m.level_pressure << 999.98, 2000.0;
    m.static_deflection = Array2::Constant(2, 11, 1e-6);
    m.static_deflection_uncertainty = Array2::Constant(2, 11, 5e-9);
    truth.levels.push_back({"h01.gsf", 990.0 * Pa, 1000.0 * Pa, Array1::Constant(8, 1e-6 - 5e-9)});
    m.pressure_covariance = {Matrix::Constant(11, 11, 3.0) + Matrix::Identity(11, 11)};
  }
};

TEST(JudgeMeasurement, HoldsARunAgainstTheTruthOfItsName) {
  const Case test;
  const auto found = judge(test.m, test.truth);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].run, "Q5");
  EXPECT_EQ(found[0].reading.n_answered, 7);
  EXPECT_EQ(found[0].reading.n_silent, 0);
  EXPECT_NEAR(found[0].reading.mean, (5.0 + 6.0 * 3.0) / 7.0, 1e-9);
  EXPECT_NEAR(found[0].reading.largest, 5.0, 1e-9);
  EXPECT_NEAR(found[0].reading.coverage, 6.0 / 7.0, 1e-12);
  EXPECT_NEAR(found[0].true_drop, 600.0, 1e-9);
  EXPECT_NEAR(found[0].drop_error, 2.0, 1e-9);
  EXPECT_NEAR(found[0].drop_pull, 2.0 / std::sqrt(4.0 + 4.0 - 2.0 * 3.0), 1e-9);
}

TEST(JudgeMeasurement, HoldsDeflectionsAgainstTheirTruth) {
  Case test;
  test.m.deflection(0, 3) = kNan;
  const auto found = judge(test.m, test.truth);
  EXPECT_EQ(found[0].deflection.n_answered, 6);
  EXPECT_EQ(found[0].deflection.n_silent, 1);
  EXPECT_NEAR(found[0].deflection.rms, 4e-9, 1e-20);
  EXPECT_NEAR(found[0].deflection.pull_mean, 2.0, 1e-9);
  EXPECT_EQ(found[0].deflection.coverage, 0.0);  // 4 nm lie outside 1.96 * 2 nm
}

TEST(JudgeMeasurement, HoldsStaticCurvesAgainstTheTruthOfTheirLabel) {
  const Case test;
  const auto levels = judge_levels(test.m, test.truth);
  ASSERT_EQ(levels.size(), 1u);  // the truth knows of one
  EXPECT_EQ(levels[0].pressure, 999.98);
  EXPECT_EQ(levels[0].deflection.n_answered, 11);
  EXPECT_NEAR(levels[0].deflection.mean, 5e-9, 1e-20);
  EXPECT_EQ(levels[0].deflection.coverage, 1.0);
  EXPECT_EQ(judge_levels(test.m, test.truth, 3.5 * mm, 9.5 * mm)[0].deflection.n_answered, 6);
  twin::Truth of_runs = test.truth;
  of_runs.levels.clear();
  EXPECT_TRUE(judge_levels(test.m, of_runs).empty());
}

TEST(JudgeMeasurement, JudgesTheStretchThatIsAsked) {
  const Case test;
  const auto found = judge(test.m, test.truth, 3.5 * mm, 9.5 * mm);
  EXPECT_EQ(found[0].x_start, 3.5e-3);
  EXPECT_EQ(found[0].reading.n_answered, 6);
  EXPECT_NEAR(found[0].reading.rms, 3.0, 1e-9);
  EXPECT_NEAR(found[0].true_drop, 500.0, 1e-9);  // from 4 to 9 mm
}

TEST(JudgeMeasurement, CountsSilentStationsAndTakesTheOutermostAnswers) {
  Case test;
  for (const Index ix : {2, 5, 8}) test.m.pressure(0, ix) = kNan;
  const auto found = judge(test.m, test.truth);
  EXPECT_EQ(found[0].reading.n_answered, 4);
  EXPECT_EQ(found[0].reading.n_silent, 3);
  EXPECT_NEAR(found[0].true_drop, 400.0, 1e-9);
  EXPECT_NEAR(found[0].drop_error, 0.0, 1e-9);
}

TEST(JudgeMeasurement, OfARunWithoutATestSectionHasNoAnswers) {
  Case test;
  test.m.test_section.setConstant(kNan);
  const auto found = judge(test.m, test.truth);
  EXPECT_EQ(found[0].reading.n_answered, 0);
  EXPECT_EQ(found[0].reading.n_silent, 0);
  EXPECT_EQ(found[0].true_drop, 0.0);
}

TEST(JudgeMeasurement, RefusesATruthThatLacksTheRun) {
  Case test;
  test.m.run = {"Q7"};
  try {
    judge(test.m, test.truth);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(error.found().find("Q7"), std::string::npos);
  }
}

}  // namespace
}  // namespace manoscope::pipeline
