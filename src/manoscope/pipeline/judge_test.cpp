#include "manoscope/pipeline/judge.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "manoscope/core/error.hpp"

namespace manoscope::pipeline {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Truth falls from 1000 Pa by 100 Pa a millimetre; the reading is 3 Pa too high, 5 Pa at the
/// start.
struct Case {
  results::Measurement m;
  twin::Truth truth;

  Case() {
    m.x = Array1::LinSpaced(11, 0.0, 10e-3);
    truth.x = Array1::LinSpaced(8, 0.0, 10e-3);  // other stations: a straight line all the same
    truth.runs.push_back({"other", Array1::Zero(8), Array1::Zero(8)});
    truth.runs.push_back({"Q5", 1000.0 - 1e5 * truth.x, Array1::Zero(8)});
    m.run = {"Q5"};
    m.flow_rate = Array1::Ones(1);
    m.test_section = Array2(1, 2);
    m.test_section << 2e-3, 8e-3;
    m.pressure = (1003.0 - 1e5 * m.x).matrix().transpose().array();
    m.pressure(0, 2) += 2.0;
    m.pressure_uncertainty = Array2::Constant(1, 11, 2.0);
    m.pressure_lower = m.pressure - 4.0;
    m.pressure_upper = m.pressure + 4.0;
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
