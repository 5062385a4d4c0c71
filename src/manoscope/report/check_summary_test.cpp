#include "manoscope/report/check_summary.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "manoscope/report/figures.hpp"
#include "manoscope/report/html_checks.hpp"
#include "tests/support/example_measurement.hpp"

namespace manoscope::report {
namespace {

using results::Measurement;
using test_support::example_measurement;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

Measurement with_levels() {
  Measurement m;
  m.level_pressure = Array1{{0.0, 100.0, 200.0, 300.0, 400.0}};
  m.left_out_mean_error = Array1{{kNan, 3.0, -4.0, 0.0, kNan}};
  m.left_out_mean_uncertainty = Array1{{kNan, 3.0, 2.0, 2.0, kNan}};
  return m;
}

TEST(SummariseLeftOut, HasRmsOfErrorsAndPullsAndTheWorstLevel) {
  const LeftOutSummary all = summarise_left_out(with_levels());
  EXPECT_EQ(all.n, 3);
  EXPECT_DOUBLE_EQ(all.rms, std::sqrt(25.0 / 3.0));
  EXPECT_DOUBLE_EQ(all.pull, std::sqrt(5.0 / 3.0));
  EXPECT_EQ(all.worst, 2);
  EXPECT_DOUBLE_EQ(all.worst_pull, -2.0);
}

TEST(SummariseLeftOut, OfExactLabelsHasErrorsAlone) {
  Measurement m = with_levels();
  m.left_out_mean_uncertainty = Array1{{kNan, 0.0, 0.0, 0.0, kNan}};
  const LeftOutSummary all = summarise_left_out(m);
  EXPECT_TRUE(std::isnan(all.pull));
  EXPECT_EQ(all.worst, 2);
  EXPECT_EQ(check_lines(m).front(), "Leaving one level out: rms 2.9 Pa over 3 levels.");
}

TEST(SummariseShapes, PutsFirstWhatCouldDoMostToThePressure) {
  Measurement m;
  m.level_pressure_uncertainty = Array1::Constant(4, 10.0);
  m.map = {"a", "b", "c", "d"};
  m.shape_reduced_chi_square = Array1{{1.0, 9.0, 0.9, kNan}};
  m.shape_p_value = Array1{{0.5, 1e-9, 1e-5, kNan}};
  m.shape_reading_shift = Array1{{0.0, 2.0, 30.0, kNan}};
  m.shape_worst = Array2::Constant(4, 2, 5e-3);
  const ShapeSummary all = summarise_shapes(m);
  EXPECT_EQ(all.n, 3);
  EXPECT_EQ(all.median, 1.0);
  EXPECT_EQ(all.unlike, (std::vector<Index>{2, 1}));
  EXPECT_EQ(all.n_matter, 1);
  const std::string line = check_lines(m).front();
  EXPECT_NE(line.find("2 stand out, 1 by more than the bars of p(x), most of all c (0.9): up to 30 "
                      "Pa at x = 5.00 to 5.00 mm"),
            std::string::npos)
      << line;
  m.shape_reading_shift = Array1{{0.0, 2.0, 1.0, kNan}};
  EXPECT_NE(check_lines(m).front().find("none by as much as the bars of p(x) (2 Pa)"),
            std::string::npos)
      << check_lines(m).front();
}

TEST(SummariseRepeats, AddsStatesUp) {
  const Measurement m = example_measurement({.n_x = 30, .n_levels = 6, .n_runs = 2});
  const RepeatSummary all = summarise_repeats(m);
  EXPECT_EQ(all.n, 2);
  EXPECT_EQ(all.n_maps, 5);
  EXPECT_DOUBLE_EQ(all.chi_square, 32.4);
  EXPECT_DOUBLE_EQ(all.dof, 6.0);
  EXPECT_EQ(
      check_lines(m).back(),
      "Repeats: 5 maps of 2 states, chi-square 5.4 per degree of freedom (6): 1 state scatters "
      "by more than the bars.");
}

TEST(CheckLines, AreNoneOfAnEmptyResult) {
  EXPECT_TRUE(check_lines(Measurement{}).empty());
  EXPECT_EQ(checks_part(Measurement{}), "");
}

TEST(ChecksPart, HasATableOfEachCheckAndEscapesNames) {
  Measurement m = example_measurement({.n_x = 30, .n_levels = 6, .n_runs = 2});
  m.repeat[0] = "<script>";
  const std::string part = checks_part(m);
  for (const char* text : {"id=\"checks\"", "Left out − label", "χ²/ν", "10<sup>-30</sup>",
                           "Scatter (Pa)", "Improve first"}) {
    EXPECT_NE(part.find(text), std::string::npos) << text;
  }
  EXPECT_EQ(part.find("<script>"), std::string::npos);
}

TEST(CheckFigures, AreThereWhereThereIsSomethingToShow) {
  const Measurement m = example_measurement({.n_x = 30, .n_levels = 6, .n_runs = 2});
  for (const auto& figure : {levels_left_out(m), cross_sections(m), worst_cross_section(m)}) {
    ASSERT_TRUE(figure);
    EXPECT_NO_THROW(draw(*figure, false)) << figure->name;
  }
  Measurement alike = m;
  alike.shape_p_value.setConstant(0.3);
  EXPECT_FALSE(worst_cross_section(alike));
  EXPECT_FALSE(levels_left_out(Measurement{}));
  EXPECT_FALSE(cross_sections(Measurement{}));
  EXPECT_FALSE(worst_cross_section(Measurement{}));
}

}  // namespace
}  // namespace manoscope::report
