#include "manoscope/report/advice.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/example_measurement.hpp"

namespace manoscope::report {
namespace {

using test_support::example_measurement;

/// Two runs, three stations, two sources of which the second makes these shares of the variance.
results::Measurement with_shares(const Array2& share) {
  results::Measurement m;
  m.x = Array1{{1e-3, 2e-3, 3e-3}};
  m.flow_rate = Array1::Ones(2);
  m.test_section = Array2(2, 2);
  m.test_section << 0.0, 5e-3, 0.0, 5e-3;
  m.pressure_uncertainty = Array2::Constant(2, 3, 4.0);
  m.budget_source = {"pixel noise", "pressure labels"};
  m.pressure_variance = {16.0 * (1.0 - share), 16.0 * share};
  m.extracted_drop_variance = Array2(2, 2);
  m.extracted_drop_variance << 30.0, 50.0, 10.0, 10.0;
  return m;
}

TEST(Advice, NamesTheSourceOfTheMedianStation) {
  Array2 share(2, 3);
  share << 0.1, 0.8, 0.9, 0.2, 0.8, 1.0;
  const auto advice = advice_on_pressure(with_shares(share));
  ASSERT_TRUE(advice);
  EXPECT_EQ(advice->source, "pressure labels");
  EXPECT_DOUBLE_EQ(advice->share, 0.8);
  // Half of the source's own uncertainty: a quarter of its variance. 1 - sqrt(0.2 + 0.2).
  EXPECT_NEAR(advice->shrink, 1.0 - std::sqrt(0.4), 1e-12);
  EXPECT_NE(advice->hint.find("gauge"), std::string::npos);
}

TEST(Advice, OnTheDropStandsOnItsOwnBudget) {
  const auto advice = advice_on_drop(with_shares(Array2::Constant(2, 3, 0.9)));
  ASSERT_TRUE(advice);
  EXPECT_EQ(advice->source, "pixel noise");
  EXPECT_NEAR(advice->share, 50.0 / 60.0, 1e-12);  // the upper of two medians
  EXPECT_NE(advice->hint.find("average"), std::string::npos);
}

TEST(Advice, IsTwoSentencesOrOne) {
  const std::string apart = advice_text(with_shares(Array2::Constant(2, 3, 0.9)));
  EXPECT_NE(apart.find("Improve first: pressure labels, 90 % of the variance of p(x); halved, its "
                       "bars shrink by 43 %: "),
            std::string::npos)
      << apart;
  EXPECT_NE(apart.find("\nFor the drop: pixel noise, 83 % of the variance of dp_e"),
            std::string::npos)
      << apart;
  const std::string together = advice_text(with_shares(Array2::Constant(2, 3, 0.2)));
  EXPECT_NE(together.find("pixel noise, 80 % of the variance of p(x) and 83 % of that of dp_e"),
            std::string::npos)
      << together;
}

TEST(Advice, CountsStationsOfTheTestSectionAlone) {
  Array2 share(2, 3);
  share << 0.9, 0.1, 0.9, 0.9, 0.1, 0.9;
  results::Measurement m = with_shares(share);
  m.test_section << 1.5e-3, 2.5e-3, 1.5e-3, 2.5e-3;
  EXPECT_EQ(advice_on_pressure(m)->source, "pixel noise");
  m.test_section.setConstant(std::nan(""));
  EXPECT_FALSE(advice_on_pressure(m));
  EXPECT_EQ(advice_text(m), "");
}

TEST(Advice, HasNothingToSayOfACalibrationAlone) {
  EXPECT_EQ(advice_text(example_measurement({.n_x = 30, .n_levels = 4, .n_runs = 0})), "");
}

TEST(Advice, HasAHintForEverySourceOfTheManual) {
  const std::string without = hint_for("no such source");
  for (const char* source :
       {"pixel noise", "leveling", "registration", "pressure labels", "gauge gain", "gauge zero",
        "interpolation", "end effect", "smoothness", "wall model", "quadrature"}) {
    EXPECT_NE(hint_for(source), without) << source;
  }
}

}  // namespace
}  // namespace manoscope::report
