#include "manoscope/report/gnuplot.hpp"

#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/support/changed_environment.hpp"

namespace manoscope::report {
namespace {

bool gnuplot_is_missing() { return !run_gnuplot("exit"); }

TEST(Gnuplot, ReturnsWhatTheScriptPrints) {
  if (gnuplot_is_missing()) GTEST_SKIP() << "gnuplot is not installed";
  const auto output = run_gnuplot("set print '-'\nprint 6*7\n");
  ASSERT_TRUE(output);
  EXPECT_TRUE(output->succeeded) << output->messages;
  EXPECT_EQ(output->bytes, "42\n");
}

TEST(Gnuplot, TakesAScriptFarLargerThanAPipe) {
  if (gnuplot_is_missing()) GTEST_SKIP() << "gnuplot is not installed";
  std::string script = "set print '-'\n";
  for (int i = 0; i < 40000; ++i) script += "print 'line of output'\n";
  const auto output = run_gnuplot(script);
  EXPECT_TRUE(output->succeeded);
  EXPECT_EQ(output->bytes.size(), 40000u * 15u);
}

TEST(Gnuplot, SaysWhatIsWrongWithAScript) {
  if (gnuplot_is_missing()) GTEST_SKIP() << "gnuplot is not installed";
  const auto output = run_gnuplot("plot $nothing with lines\nset print '-'\nprint 'went on'\n");
  ASSERT_TRUE(output);
  EXPECT_FALSE(output->succeeded);
  EXPECT_FALSE(output->messages.empty());
  EXPECT_EQ(output->bytes.find("went on"), std::string::npos);
}

TEST(Gnuplot, IsAbsentWhereThePathDoesNotLeadToIt) {
  const test_support::ChangedEnvironment path("PATH", "/nonexistent");
  EXPECT_FALSE(run_gnuplot("exit"));
}

}  // namespace
}  // namespace manoscope::report
