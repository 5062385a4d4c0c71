#include "manoscope/report/flow_verdict.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>

#include "tests/support/example_measurement.hpp"

namespace manoscope::report {
namespace {

TEST(FlowVerdict, NeedsTheDropAndThePressureAlongTheChannel) {
  EXPECT_EQ(flow_verdict(0.3, 0.5), FlowVerdict::agrees);
  EXPECT_EQ(flow_verdict(1.0, 0.01), FlowVerdict::agrees);  // both bounds belong to it
  EXPECT_EQ(flow_verdict(0.3, 0.0099), FlowVerdict::only_drop);
  EXPECT_EQ(flow_verdict(1.001, 0.5), FlowVerdict::differs);
  EXPECT_EQ(flow_verdict(5.0, 1e-9), FlowVerdict::differs);
}

TEST(FlowVerdict, IsNoneWithoutANumberAndNeverMoreThanWhatIsKnown) {
  const double nan = std::nan("");
  EXPECT_EQ(flow_verdict(nan, 0.5), FlowVerdict::none);
  EXPECT_EQ(flow_verdict(nan, nan), FlowVerdict::none);
  EXPECT_EQ(flow_verdict(0.3, nan), FlowVerdict::only_drop);
  EXPECT_EQ(flow_verdict(results::Measurement{}, -1, 0), FlowVerdict::none);
}

TEST(FlowVerdict, HasAWordForEach) {
  EXPECT_STREQ(verdict_word(FlowVerdict::agrees), "agrees");
  EXPECT_STREQ(verdict_word(FlowVerdict::only_drop), "only the drop");
  EXPECT_STREQ(verdict_word(FlowVerdict::differs), "differs");
  EXPECT_STREQ(verdict_word(FlowVerdict::none), "no verdict");
}

TEST(FlowVerdict, ReadsTheRowOfAModel) {
  const auto m = test_support::example_measurement({.n_x = 30, .n_levels = 4, .n_runs = 2});
  // E_n 0.1 and chance 0.54; 0.5 and 1e-10; 1.5.
  EXPECT_EQ(flow_verdict(m, flow_model_row(m, "section-march"), 1), FlowVerdict::agrees);
  EXPECT_EQ(flow_verdict(m, flow_model_row(m, "paper"), 1), FlowVerdict::only_drop);
  EXPECT_EQ(flow_verdict(m, flow_model_row(m, "momentum"), 1), FlowVerdict::differs);
  EXPECT_EQ(flow_model_row(m, "turbulent"), -1);
}

TEST(ModelStyle, TellsTheModelsApart) {
  std::set<std::string> words, colours;
  for (const char* name :
       {"paper", "creeping", "momentum", "energy", "developing", "plane-march", "section-march"}) {
    words.insert(model_style(name).words);
    colours.insert(model_style(name).colour);
  }
  EXPECT_EQ(words.size(), 7u);
  EXPECT_EQ(colours.size(), 7u);
  EXPECT_STREQ(model_style("`touch evil`").words, "another model");
}

}  // namespace
}  // namespace manoscope::report
