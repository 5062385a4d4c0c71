#include "manoscope/report/figures.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "manoscope/report/gnuplot.hpp"
#include "manoscope/report/plot_script.hpp"
#include "tests/support/example_measurement.hpp"

namespace manoscope::report {
namespace {

using test_support::example_measurement;

TEST(PlotScript, BreaksALineWhereAValueIsMissing) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  PlotScript script;
  const auto name = script.add_data({Array1{{1, 2, 3, 4, 5}}, Array1{{nan, 2, nan, nan, 5}}});
  EXPECT_EQ(script.text(), name + " << END\n2 2\n\n5 5\nEND\n");
}

TEST(PlotScript, DrawsNothingWithoutData) {
  PlotScript script;
  EXPECT_EQ(script.add_data({Array1{{std::nan("")}}}), "");
  script.draw("", "with lines").plot();
  EXPECT_FALSE(script.has_content());
}

TEST(PlotScript, ThinsToWhatTheEyeCanTell) {
  EXPECT_EQ(thinned(Array1::Zero(500)).size(), 500);
  EXPECT_LE(thinned(Array1::Zero(974)).size(), 500);
  EXPECT_EQ(thinned(Array1::LinSpaced(1001, 0, 1000))(1), 3.0);  // every third of 1001
  EXPECT_EQ(thinned(Array1()).size(), 0);
}

TEST(OrderedColour, RunsFromDarkToLightAndNeverToWhite) {
  EXPECT_EQ(ordered_colour(0, 1), "#440154");
  double last = -1.0;
  for (Index i = 0; i < 12; ++i) {
    const std::string colour = ordered_colour(i, 12);
    const auto part = [&](std::size_t at) { return std::stoi(colour.substr(at, 2), nullptr, 16); };
    const double luminance = 0.2126 * part(1) + 0.7152 * part(3) + 0.0722 * part(5);
    EXPECT_GT(luminance, last);
    EXPECT_LT(luminance, 190.0);
    last = luminance;
  }
}

TEST(Figures, HoldNoTextOfTheUser) {
  auto measurement = example_measurement({.n_x = 40, .n_levels = 4, .n_runs = 2});
  measurement.title = measurement.run[0] = measurement.map[0] = measurement.flow_model[0] =
      measurement.verdict[0] = measurement.correction[1] = "`touch evil`";
  for (const Figure& figure : figures(measurement)) {
    EXPECT_EQ(figure.script.find("evil"), std::string::npos) << figure.name;
  }
}

TEST(Figures, LeaveOutTheLogarithmicPanelWithoutPositiveValues) {
  auto measurement = example_measurement({.n_x = 40, .n_levels = 6, .n_runs = 0});
  EXPECT_NE(crest_deflection(measurement)->script.find("logscale"), std::string::npos);
  measurement.crest_deflection.setConstant(-1e-6);
  EXPECT_EQ(crest_deflection(measurement)->script.find("logscale"), std::string::npos);
}

TEST(Figures, ShowOneRunAsTheHighest) {
  const auto measurement = example_measurement({.n_x = 40, .n_levels = 6, .n_runs = 1});
  EXPECT_FALSE(pressure_at_lowest_flow(measurement));
  EXPECT_TRUE(pressure_at_highest_flow(measurement));
}

TEST(Figures, FitTheStraightLineThroughTheTestSection) {
  auto measurement = example_measurement({.n_x = 100, .n_levels = 6, .n_runs = 1});
  // p = 9 kPa - 0.5 kPa/mm x, but wild outside the test section.
  for (Index ix = 0; ix < 100; ++ix) {
    const double x = measurement.x(ix);
    const bool inside = x >= measurement.test_section(0, 0) && x <= measurement.test_section(0, 1);
    measurement.pressure(0, ix) = inside ? 9e3 - 5e5 * x : 1e5;
  }
  const std::string script = pressure_at_highest_flow(measurement)->script;
  EXPECT_NE(script.find("linear fit, −0.500 kPa/mm"), std::string::npos);
}

TEST(Figures, SpeakInUnitsThatSuitTheNumbers) {
  auto measurement = example_measurement({.n_x = 40, .n_levels = 6, .n_runs = 2});
  EXPECT_NE(static_profiles(measurement)->script.find("(µm)"), std::string::npos);
  measurement.static_deflection *= 1e-3;
  EXPECT_NE(static_profiles(measurement)->script.find("(nm)"), std::string::npos);
}

}  // namespace
}  // namespace manoscope::report
