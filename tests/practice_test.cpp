// The practice experiments: virtual channels made by an independent wall-and-flow model, with
// truth.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <string>

#include "manoscope/core/flags.hpp"
#include "manoscope/experiment/experiment.hpp"
#include "manoscope/io/csv_table.hpp"
#include "manoscope/pipeline/judge.hpp"
#include "manoscope/pipeline/measure.hpp"
#include "manoscope/results/write.hpp"
#include "tests/support/paths.hpp"

namespace manoscope {
namespace {

namespace fs = std::filesystem;

class Practice : public ::testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    folder_ = fs::path(test_paths::shared) / "data" / "practice" / GetParam();
    if (!fs::exists(folder_)) GTEST_SKIP() << folder_ << " is not on this machine";
  }
  /// Measured once for all tests.
  const results::Measurement& measured() const {
    static std::map<std::string, results::Measurement> once;
    auto [place, is_new] = once.try_emplace(GetParam());
    if (is_new) place->second = pipeline::measure(experiment::read_experiment(folder_));
    return place->second;
  }
  fs::path folder_;
};

TEST_P(Practice, PressureAndDropsAgreeWithTheTruth) {
  const results::Measurement& measurement = measured();
  const auto judgements =
      pipeline::judge(measurement, twin::read_truth(folder_), 1.6 * mm, 13.0 * mm);
  ASSERT_EQ(judgements.size(), 8u);
  EXPECT_EQ(measurement.reading.find("through the influence operator"), 0U) << measurement.reading;
  for (const auto& run : judgements) {
    // Labels of 10 Pa taken together leave 4 Pa, maps and the wall's own neighbourhood as much.
    EXPECT_LE(run.reading.rms, 10.0) << run.run;
    EXPECT_LE(std::abs(run.drop_error), std::max(50.0, 0.015 * run.true_drop)) << run.run;
    EXPECT_EQ(run.reading.n_silent, 0) << run.run;
  }
  for (Index r = 0; r < measurement.flow_rate.size(); ++r) {
    EXPECT_NEAR(measurement.test_section(r, 0), 1.6e-3, 0.1e-3);
    EXPECT_GT(measurement.test_section(r, 1), 13.0e-3);
  }
}

/// Truth of a flow run by the name of its column.
Array1 truth_column(const fs::path& folder, const std::string& name) {
  const fs::path file = folder / "truth" / "truth_scalars.csv";
  const auto table = io::read_csv_table(file);
  const std::size_t column = table.column(name).value();
  Array1 values(static_cast<Index>(table.rows.size()));
  for (Index r = 0; r < values.size(); ++r) {
    values[r] = table.cell_number(table.rows[static_cast<std::size_t>(r)], column).value();
  }
  return values;
}

TEST_P(Practice, FlowRateIsReadOffTheDeflectionAlone) {
  const results::Measurement& m = measured();
  for (Index r = 0; r < m.flow_rate.size(); ++r) {
    const double off = m.inferred_flow_rate[r] - m.flow_rate[r];
    EXPECT_LE(std::abs(off), 0.02 * m.flow_rate[r]) << m.run[static_cast<std::size_t>(r)];
    EXPECT_LE(std::abs(off), 2.0 * m.inferred_flow_rate_uncertainty[r]);
  }
}

TEST_P(Practice, DropOfTheChannelIsPredictedFromTheCalibration) {
  const results::Measurement& m = measured();
  const Array1 truth = truth_column(folder_, "dp_compliant_Pa");
  ASSERT_EQ(truth.size(), m.flow_rate.size());
  for (Index r = 0; r < m.flow_rate.size(); ++r) {
    const double off = m.predicted_drop[r] - truth[r];
    EXPECT_LE(std::abs(off), 0.02 * truth[r]) << m.run[static_cast<std::size_t>(r)];
    EXPECT_LE(std::abs(off), 2.0 * m.predicted_drop_uncertainty[r]);
  }
}

TEST_P(Practice, VerdictsAgree) {
  // The truth is a momentum balance on true sections, and the gap is stated as it is known.
  const results::Measurement& m = measured();
  EXPECT_EQ(m.verdict_model, "momentum");
  for (const std::string& verdict : m.verdict) {
    EXPECT_EQ(verdict.rfind("agree within", 0), 0u) << verdict;
  }
}

TEST_P(Practice, SensitivityEndsAtTheClampsAndIsFlaggedThere) {
  const results::Measurement& measurement = measured();
  for (Index r = 0; r < measurement.flow_rate.size(); ++r) {
    for (const Index end : {Index{0}, measurement.x.size() - 1}) {
      EXPECT_NE(measurement.pressure_flags(r, end) & ReadingFlag::outside_test_section, 0);
    }
    for (Index ix = 0; ix < measurement.x.size(); ++ix) {
      const bool silent = (measurement.pressure_flags(r, ix) & ReadingFlag::no_answer) != 0;
      EXPECT_EQ(std::isnan(measurement.pressure(r, ix)), silent);
    }
  }
}

TEST_P(Practice, ResultFileKeepsTheContractInPython) {
  const auto out = fs::temp_directory_path() / (std::string("manoscope_practice_") + GetParam());
  fs::remove_all(out);
  results::write_result(out, measured(), {});
  const std::string command = std::string(test_paths::python) + " " + test_paths::source +
                              "/tests/python/result_contract_test.py " +
                              (out / "result.nc").string();
  EXPECT_EQ(std::system(command.c_str()), 0) << command;
  fs::remove_all(out);
}

INSTANTIATE_TEST_SUITE_P(Samples, Practice, ::testing::Values("S1", "S4"));

}  // namespace
}  // namespace manoscope
