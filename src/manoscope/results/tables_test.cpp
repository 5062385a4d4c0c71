#include "manoscope/results/tables.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "manoscope/core/flags.hpp"
#include "manoscope/io/csv_table.hpp"
#include "tests/support/example_measurement.hpp"

namespace manoscope::results {
namespace {

TEST(Tables, HoldTheColumnsOfTheContract) {
  const auto measurement =
      test_support::example_measurement({.n_x = 8, .n_levels = 3, .n_runs = 1});
  EXPECT_EQ(pressure_table(measurement).substr(0, pressure_table(measurement).find('\n')),
            "run,flow_rate_m3_s,x_m,pressure_Pa,pressure_uncertainty_Pa,pressure_lower_Pa,"
            "pressure_upper_Pa,deflection_m,flags");
  // Columns may be added behind those of the contract, never before or between them.
  const std::string contract =
      "run,flow_rate_m3_s,reynolds,x_start_m,x_end_m,extracted_drop_Pa,"
      "extracted_drop_uncertainty_Pa,resistance_drop_Pa,resistance_drop_uncertainty_Pa,"
      "transducer_drop_Pa,parasitic_drop_Pa,en_number,";
  EXPECT_EQ(drops_table(measurement).substr(0, contract.size()), contract);
}

TEST(Tables, HoldWhatTheFlowSaysOfEveryRun) {
  auto m = test_support::example_measurement({.n_x = 30, .n_levels = 5, .n_runs = 3});
  m.verdict[1] = "do not agree: 3 % more, \"twice\" the bar";
  const auto table = io::parse_csv_table(drops_table(m), "drops.csv");
  ASSERT_EQ(table.rows.size(), 3u);
  const auto expect_column = [&](const std::string& name, const Array1& values) {
    const auto column = table.column(name);
    ASSERT_TRUE(column) << name;
    for (Index run = 0; run < 3; ++run) {
      const auto& row = table.rows[static_cast<std::size_t>(run)];
      if (std::isnan(values(run))) {
        EXPECT_EQ(row.cells[*column], "") << name;
      } else {
        EXPECT_EQ(table.cell_number(row, *column), values(run)) << name;
      }
    }
  };
  expect_column("reduced_reynolds", m.reduced_reynolds);
  expect_column("parasitic_drop_uncertainty_Pa", m.parasitic_drop_uncertainty);
  expect_column("compliant_drop_Pa", m.compliant_drop);  // the third run has no transducer
  expect_column("compliant_drop_uncertainty_Pa", m.compliant_drop_uncertainty);
  expect_column("predicted_drop_Pa", m.predicted_drop);
  expect_column("predicted_drop_uncertainty_Pa", m.predicted_drop_uncertainty);
  expect_column("predicted_en_number", m.predicted_en_number);
  expect_column("inferred_flow_rate_m3_s", m.inferred_flow_rate);
  expect_column("inferred_flow_rate_uncertainty_m3_s", m.inferred_flow_rate_uncertainty);
  expect_column("friction_drag_N", m.friction_drag);
  expect_column("relative_friction_drag", m.relative_friction_drag);
  expect_column("true_section_Pa", m.correction_drop.row(1));
  expect_column("entry_uncertainty_Pa", m.correction_uncertainty.row(3));
  expect_column("section_march_Pa", m.correction_drop.row(4));
  expect_column("mean_gap_rectangle_Pa", m.correction_drop.row(0));
  expect_column("paper_model_drop_Pa", m.model_drop.row(0));
  expect_column("momentum_model_en_number", m.model_en_number.row(2));
  expect_column("section_march_model_drop_uncertainty_Pa", m.model_drop_uncertainty.row(3));
  expect_column("section_march_model_p_value", m.model_p_value.row(3));
  const auto verdict = table.column("verdict").value();
  for (std::size_t run = 0; run < 3; ++run) {
    EXPECT_EQ(table.rows[run].cells[verdict], m.verdict[run]);
  }
  EXPECT_NE(drops_table(m).find("\"do not agree: 3 % more, \"\"twice\"\" the bar\"\n"),
            std::string::npos);
}

TEST(Tables, HoldNoColumnOfAModelThatWasNotRun) {
  auto m = test_support::example_measurement({.n_x = 8, .n_levels = 3, .n_runs = 2});
  m.flow_model.clear();
  m.correction.clear();
  m.verdict.clear();
  const auto table = io::parse_csv_table(drops_table(m), "drops.csv");
  EXPECT_FALSE(table.column("paper_model_drop_Pa"));
  EXPECT_FALSE(table.column("true_section_Pa"));
  EXPECT_EQ(table.rows[1].cells[table.column("verdict").value()], "");
}

TEST(Tables, ReadBackToTheSameNumbersWithEmptyCellsForMissingOnes) {
  auto measurement = test_support::example_measurement({.n_x = 40, .n_levels = 5, .n_runs = 3});
  measurement.run[1] = "Q \"10\", second";
  const auto table = io::parse_csv_table(pressure_table(measurement), "pressure.csv");
  ASSERT_EQ(table.rows.size(), 120u);
  const auto pressure = table.column("pressure_Pa").value();
  const auto flags = table.column("flags").value();
  int n_missing = 0;
  for (Index run = 0; run < 3; ++run) {
    for (Index ix = 0; ix < 40; ++ix) {
      const auto& row = table.rows[static_cast<std::size_t>(run * 40 + ix)];
      EXPECT_EQ(row.cells[0], measurement.run[static_cast<std::size_t>(run)]);
      EXPECT_EQ(row.cells[flags], flag_names(measurement.pressure_flags(run, ix)));
      const double expected = measurement.pressure(run, ix);
      if (std::isnan(expected)) {
        EXPECT_EQ(row.cells[pressure], "");
        ++n_missing;
      } else {
        EXPECT_EQ(table.cell_number(row, pressure), expected);  // shortest digits: exact
      }
    }
  }
  EXPECT_GT(n_missing, 0);
}

TEST(Tables, LeaveTheTransducerEmptyWhereThereIsNone) {
  const auto measurement =
      test_support::example_measurement({.n_x = 30, .n_levels = 5, .n_runs = 3});
  ASSERT_TRUE(std::isnan(measurement.transducer_drop(2)));
  const auto table = io::parse_csv_table(drops_table(measurement), "drops.csv");
  const auto transducer = table.column("transducer_drop_Pa").value();
  EXPECT_EQ(table.cell_number(table.rows[1], transducer), measurement.transducer_drop(1));
  EXPECT_EQ(table.rows[2].cells[transducer], "");
}

TEST(Tables, HoldOnlyTheHeaderWithoutRuns) {
  const auto measurement =
      test_support::example_measurement({.n_x = 8, .n_levels = 3, .n_runs = 0});
  const std::string table = drops_table(measurement);
  EXPECT_EQ(table.find('\n'), table.size() - 1);
}

TEST(FlagNames, JoinTheNamesInTheOrderOfTheBits) {
  EXPECT_EQ(flag_names(0), "");
  EXPECT_EQ(flag_names(ReadingFlag::outside_test_section | ReadingFlag::ambiguous),
            "ambiguous|outside_test_section");
  EXPECT_EQ(flag_names(1 | 128), "no_data|bit_7");
}

}  // namespace
}  // namespace manoscope::results
