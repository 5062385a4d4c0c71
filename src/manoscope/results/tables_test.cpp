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
  EXPECT_EQ(drops_table(measurement).substr(0, drops_table(measurement).find('\n')),
            "run,flow_rate_m3_s,reynolds,x_start_m,x_end_m,extracted_drop_Pa,"
            "extracted_drop_uncertainty_Pa,resistance_drop_Pa,resistance_drop_uncertainty_Pa,"
            "transducer_drop_Pa,parasitic_drop_Pa,en_number");
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
