// The practice experiments: virtual channels made by an independent wall-and-flow model, with
// truth.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "manoscope/core/flags.hpp"
#include "manoscope/experiment/experiment.hpp"
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
  fs::path folder_;
};

TEST_P(Practice, PressureAndDropsAgreeWithTheTruth) {
  const auto experiment = experiment::read_experiment(folder_);
  const auto measurement = pipeline::measure(experiment);
  const auto judgements =
      pipeline::judge(measurement, twin::read_truth(folder_), 1.6 * mm, 13.0 * mm);
  ASSERT_EQ(judgements.size(), experiment.flow.size());
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

TEST_P(Practice, SensitivityEndsAtTheClampsAndIsFlaggedThere) {
  const auto measurement = pipeline::measure(experiment::read_experiment(folder_));
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
  results::write_result(out, pipeline::measure(experiment::read_experiment(folder_)), {});
  const std::string command = std::string(test_paths::python) + " " + test_paths::source +
                              "/tests/python/result_contract_test.py " +
                              (out / "result.nc").string();
  EXPECT_EQ(std::system(command.c_str()), 0) << command;
  fs::remove_all(out);
}

INSTANTIATE_TEST_SUITE_P(Samples, Practice, ::testing::Values("S1", "S4"));

}  // namespace
}  // namespace manoscope
