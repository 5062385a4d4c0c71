#include <gtest/gtest.h>

#include <cmath>

#include "manoscope/report/figures.hpp"
#include "manoscope/report/gnuplot.hpp"
#include "manoscope/report/html_flow.hpp"
#include "manoscope/report/html_simulation.hpp"
#include "manoscope/report/simulated_lines.hpp"
#include "tests/support/example_measurement.hpp"
#include "tests/support/example_simulation.hpp"

namespace manoscope::report {
namespace {

using results::Measurement;
using test_support::example_simulation;

Measurement example() {
  Measurement m = test_support::example_measurement({.n_x = 60, .n_levels = 5, .n_runs = 3});
  return m;
}

Measurement simulated() {
  Measurement m = example();
  m.simulations = {example_simulation(m, 2, 3), example_simulation(m, 2, 2),
                   example_simulation(m, 0, 2)};
  return m;
}

bool holds(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(SimulatedLines, AreThoseOfTheRunAndMeetTheReadingAtTheEndOfTheSection) {
  const Measurement m = simulated();
  const auto lines = simulated_lines(m, 2);
  ASSERT_EQ(lines.size(), 3u);
  EXPECT_EQ(lines[0].words, "Navier-Stokes 2-D");
  EXPECT_EQ(lines[1].words, "Navier-Stokes 2-D, side walls added");
  EXPECT_EQ(lines[2].words, "Navier-Stokes 3-D");
  EXPECT_TRUE(simulated_lines(m, 1).empty());
  Index end = m.x.size() - 1;  // the last station of the section that was read
  while (m.x[end] > m.test_section(2, 1) || std::isnan(m.pressure(2, end))) --end;
  for (const SimulatedLine& line : lines) {
    EXPECT_NEAR(line.pressure[end], m.pressure(2, end), 1e-9);
    // Its own course: the drop to a station inside is the simulation's.
    const results::Simulation& s = *line.simulation;
    const Index inside = end / 2;
    const double slope = (s.pressure(line.variant, 0) - s.outlet_pressure) / m.channel_length;
    EXPECT_NEAR(line.pressure[inside] - line.pressure[end], slope * (m.x[end] - m.x[inside]),
                1e-6 * s.channel_drop);
  }
}

TEST(SimulatedLines, StandAsCrossesInTheFigureOfTheRun) {
  const auto with = pressure_at_highest_flow(simulated());
  ASSERT_TRUE(with);
  EXPECT_TRUE(holds(with->script, "title 'Navier-Stokes 2-D'"));
  EXPECT_TRUE(holds(with->script, "title 'Navier-Stokes 3-D'"));
  EXPECT_TRUE(holds(with->script, "title '2-D and side walls'"));
  EXPECT_TRUE(holds(with->script, "with points pt 1"));
  EXPECT_TRUE(holds(with->caption, "Crosses: Navier-Stokes"));
  const auto without = pressure_at_highest_flow(example());
  ASSERT_TRUE(without);
  EXPECT_FALSE(holds(without->script, "Navier-Stokes"));
  EXPECT_FALSE(holds(without->caption, "Crosses: Navier"));
  if (const auto drawn = draw(*with, false)) {
    EXPECT_TRUE(holds(drawn->svg, "Navier-Stokes 2-D"));
  } else {
    GTEST_SKIP() << "gnuplot is not installed";
  }
}

TEST(SimulationTables, StandBesideTheFlowModels) {
  const Measurement m = simulated();
  const std::string page = flow_part(m);
  EXPECT_TRUE(holds(page, "Navier-Stokes 2-D</th>"));
  EXPECT_TRUE(holds(page, "Navier-Stokes 2-D, side walls added</th>"));
  EXPECT_TRUE(holds(page, "Navier-Stokes 3-D</th>"));
  // 10 % less than the reading, with E_n 0.1/(2 * 0.02): 2.50.
  EXPECT_TRUE(holds(simulation_cells(m, 0), "−10.0 %<br><i>E</i><sub>n</sub> 2.50"));
  EXPECT_TRUE(holds(simulation_cells(m, 0), "class=\"bad\""));
  EXPECT_TRUE(holds(simulation_cells(m, 0), "class=\"good\""));
  // A run without one has a dash in every column.
  EXPECT_EQ(simulation_cells(m, 1), "<td>–</td><td>–</td><td>–</td>");
  EXPECT_TRUE(holds(simulations_table(m), "channel height"));
  EXPECT_EQ(simulation_heads(example()), "");
  EXPECT_EQ(simulations_table(example()), "");
}

TEST(SimulationTables, MarkWhatIsNotConverged) {
  Measurement m = simulated();
  m.simulations[2].converged = 0.0;
  EXPECT_TRUE(holds(simulation_cells(m, 0), "○"));
  EXPECT_TRUE(holds(simulations_table(m), "not converged"));
}

}  // namespace
}  // namespace manoscope::report
