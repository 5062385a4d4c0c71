#include "manoscope/report/judged_figures.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "manoscope/report/gnuplot.hpp"
#include "tests/support/example_measurement.hpp"

namespace manoscope::report {
namespace {

using results::Measurement;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

Measurement example() {
  return test_support::example_measurement({.n_x = 80, .n_levels = 5, .n_runs = 2});
}

/// A truth one standard uncertainty below the reading.
std::vector<JudgedRun> judged_runs(const Measurement& m) {
  std::vector<JudgedRun> runs;
  for (Index r = 0; r < m.flow_rate.size(); ++r) {
    JudgedRun run;
    run.x_start = m.test_section(r, 0);
    run.x_end = m.test_section(r, 1);
    run.true_pressure = m.pressure.row(r) - m.pressure_uncertainty.row(r);
    run.coverage = run.coverage_68 = 1.0;
    run.labels = Array1::Constant(m.x.size(), 3.0);
    run.maps = Array1::LinSpaced(m.x.size(), -5.0, 5.0);
    run.curve_shape_and_locality = Array1::Constant(m.x.size(), 1.0);
    runs.push_back(run);
  }
  return runs;
}

TEST(JudgedFigures, AreDrawnForEveryRunAndForAllTogether) {
  if (!run_gnuplot("exit")) GTEST_SKIP() << "gnuplot is not installed";
  const Measurement m = example();
  const auto files = judged_figures(m, judged_runs(m));
  ASSERT_EQ(files.size(), 5u);
  EXPECT_EQ(files[0].name, "figures/judge_error_run01.svg");
  EXPECT_EQ(files[2].name, "figures/judge_pulls.svg");
  EXPECT_EQ(files[3].name, "figures/judge_along.svg");
  EXPECT_EQ(files[4].name, "figures/judge_coverage.svg");
  for (const auto& file : files) {
    EXPECT_NE(file.bytes.find("</svg>"), std::string::npos) << file.name;
  }
}

TEST(JudgedFigures, ShowTheSumWhereTheTwoCannotBeTold) {
  const Measurement m = example();
  auto judged = judged_runs(m);
  EXPECT_NE(error_of_run(m, judged, 0)->script.find("shape and locality"), std::string::npos);
  judged[0].curve_shape = judged[0].locality = Array1::Ones(m.x.size());
  EXPECT_EQ(error_of_run(m, judged, 0)->script.find("shape and locality"), std::string::npos);
  EXPECT_NE(error_of_run(m, judged, 0)->script.find("'locality'"), std::string::npos);
}

TEST(JudgedFigures, ShowTheErrorAloneWithoutASplit) {
  const Measurement m = example();
  auto judged = judged_runs(m);
  judged[0].labels = judged[0].maps = judged[0].curve_shape_and_locality = Array1();
  const auto figure = error_of_run(m, judged, 0);
  EXPECT_EQ(figure->script.find("multiplot"), std::string::npos);
  judged[0].labels = Array1::Constant(m.x.size(), kNan);  // told, but nowhere
  EXPECT_EQ(error_of_run(m, judged, 0)->script.find("multiplot"), std::string::npos);
}

TEST(JudgedFigures, CountAPullOfOneInItsBin) {
  const Measurement m = example();
  auto judged = judged_runs(m);
  for (auto& run : judged) {  // 1.2 uncertainties, clear of the border between two bins
    run.true_pressure -= 0.2 * m.pressure_uncertainty.row(0).transpose();
  }
  judged.resize(1);
  // All of the density 1 / 0.5 stands between 1 and 1.5, nothing beside it.
  const std::string script = pulls(m, judged)->script;
  EXPECT_NE(script.find("\n1.25 2\n"), std::string::npos) << script;
  EXPECT_NE(script.find("\n0.75 0\n"), std::string::npos) << script;
}

TEST(JudgedFigures, ShowPullsBeyondFourApart) {
  const Measurement m = example();
  auto judged = judged_runs(m);
  judged.resize(1);
  const Array1 sigma = m.pressure_uncertainty.row(0);
  judged[0].true_pressure = m.pressure.row(0).transpose() - 6.0 * sigma;
  const std::string script = pulls(m, judged)->script;
  // All of them, density 1 / 0.5, in the bar at 5; none in the last one of the axis.
  EXPECT_NE(script.find("\n5 2\n"), std::string::npos) << script;
  EXPECT_NE(script.find("\n3.75 0\n"), std::string::npos) << script;
  EXPECT_NE(script.find("'100 %' at 5"), std::string::npos) << script;
  judged[0].true_pressure = m.pressure.row(0).transpose() - 1.2 * sigma;
  EXPECT_EQ(pulls(m, judged)->script.find("all beyond"), std::string::npos);
}

TEST(JudgedFigures, ShowPullsAndCoverageStationByStation) {
  const Measurement m = example();
  auto judged = judged_runs(m);
  // The first run is off by 1.5 of its uncertainties, the second by 10: of the two one interval
  // holds the truth everywhere.
  for (const Index r : {0, 1}) {
    judged[static_cast<std::size_t>(r)].true_pressure =
        (m.pressure.row(r) - (r == 0 ? 1.5 : 10.0) * m.pressure_uncertainty.row(r)).transpose();
  }
  const std::string script = pulls_along(m, judged)->script;
  EXPECT_NE(script.find(" 1.5\n"), std::string::npos) << script;
  EXPECT_NE(script.find(" 50\n"), std::string::npos) << script;
  EXPECT_EQ(script.find(" 100\n"), std::string::npos) << script;
}

TEST(JudgedFigures, ShowNothingWithoutAStretch) {
  const Measurement m = example();
  auto judged = judged_runs(m);
  for (auto& run : judged) run.x_start = run.x_end = kNan;
  EXPECT_FALSE(pulls(m, judged));
  EXPECT_FALSE(coverage_by_run(m, judged));
  EXPECT_FALSE(pulls_along(m, judged));
  EXPECT_TRUE(error_of_run(m, judged, 0));  // the error itself needs none
}

}  // namespace
}  // namespace manoscope::report
