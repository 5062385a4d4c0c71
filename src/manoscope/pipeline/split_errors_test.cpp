#include "manoscope/pipeline/split_errors.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "manoscope/core/error.hpp"
#include "manoscope/pipeline/judged_stretch.hpp"
#include "manoscope/pipeline/test_experiment.hpp"

namespace manoscope::pipeline {
namespace {

using results::Measurement;

/// Largest part in any test section, Pa.
double largest(const SplitJudgement& split,
               validation::PartSummary validation::SplitSummary::*part) {
  double most = 0.0;
  for (const RunSplit& run : split.runs) most = std::max(most, (run.summary.*part).largest);
  return most;
}
double largest(const SplitJudgement& split,
               std::optional<validation::PartSummary> validation::SplitSummary::*part) {
  double most = 0.0;
  for (const RunSplit& run : split.runs) most = std::max(most, (run.summary.*part)->largest);
  return most;
}

/// The small scenario with every error off.
twin::Scenario clean_scenario() {
  twin::Scenario scenario = small_scenario().without_errors();
  scenario.solver.steps = 480;
  return scenario;
}

using Summary = validation::SplitSummary;

/// Pa: true p(x) bends by less than this within a cell of the coupled solver, over which it loads
/// the wall by a straight line. The wall answers at x alone: all else of its locality is round-off.
constexpr double kLoadCells = 1e-3;

TEST(SplitErrors, AddUpToTheErrorOfTheResult) {
  TestExperiment test;
  const Measurement m = test.measure();
  const twin::Truth& truth = test.twin.truth;
  const SplitJudgement split = split_errors(m, truth);
  EXPECT_EQ(split.not_offered, "");
  ASSERT_EQ(split.runs.size(), 2u);
  for (Index r = 0; r < 2; ++r) {
    const RunSplit& run = split.runs[static_cast<std::size_t>(r)];
    EXPECT_EQ(run.run, m.run[static_cast<std::size_t>(r)]);
    const Array1 expected =
        interpolate(truth.x, truth.runs[static_cast<std::size_t>(r)].pressure, m.x);
    const validation::ErrorSplit& s = run.stations;
    for (Index i = 0; i < m.x.size(); ++i) {
      if (s.split[i] == 0) continue;
      // Round-off of 20 kPa in four differences.
      EXPECT_NEAR(s.neighbourhood[i] + s.labels[i] + s.maps[i] + s.curve_shape[i] + s.locality[i],
                  m.pressure(r, i) - expected[i], 1e-10);
    }
    // The curves fitted again are those of the measurement, and truth answers all over the section.
    EXPECT_GT(run.summary.n_split, 150);
    EXPECT_EQ(run.summary.n_left_out, 0);
    EXPECT_GT(run.summary.labels.rms, 1.0);
    EXPECT_GT(run.summary.maps.rms, 0.1);
  }
}

TEST(SplitErrors, WithoutAnyErrorLeaveCurveShapeAlone) {
  TestExperiment test(clean_scenario());
  const SplitJudgement split = split_errors(test.measure(), test.twin.truth);
  EXPECT_EQ(largest(split, &Summary::labels), 0.0);
  // The place of the frame, found to 20 nm, of 1 Pa/um. (32-bit floats of a map: 1.3 mPa.)
  EXPECT_LT(largest(split, &Summary::maps), 0.03);
  EXPECT_LT(largest(split, &Summary::locality), kLoadCells);
  EXPECT_GT(largest(split, &Summary::curve_shape), 0.5);
}

TEST(SplitErrors, OfLabelsAloneHaveHardlyAnyMaps) {
  twin::Scenario scenario = clean_scenario();
  scenario.gauge.noise = 10.0 * Pa;
  TestExperiment test(scenario);
  MeasureOptions alone;
  alone.curves.joint_labels = false;
  const SplitJudgement split = split_errors(test.measure(alone), test.twin.truth);
  EXPECT_GT(largest(split, &Summary::labels), 5.0);
  // All labels together leave less than half.
  const SplitJudgement joint = split_errors(test.measure(), test.twin.truth);
  EXPECT_LT(largest(joint, &Summary::labels), 0.5 * largest(split, &Summary::labels));
  // As without any error, and the place of the frame: found to 20 nm, of 1 Pa/um.
  EXPECT_LT(largest(split, &Summary::maps), 0.03);
  EXPECT_LT(largest(split, &Summary::locality), kLoadCells);
}

TEST(SplitErrors, OfPixelNoiseAloneHaveNoLabels) {
  twin::Scenario scenario = clean_scenario();
  scenario.camera.noise = 20.0 * nm;
  TestExperiment test(scenario);
  const SplitJudgement split = split_errors(test.measure(), test.twin.truth);
  EXPECT_EQ(largest(split, &Summary::labels), 0.0);
  EXPECT_GT(largest(split, &Summary::maps), 2.0);
  EXPECT_LT(largest(split, &Summary::locality), kLoadCells);
}

TEST(SplitErrors, GiveGainAndZeroOfTheGaugeToTheLabels) {
  twin::Scenario scenario = clean_scenario();
  scenario.gauge.noise = Pressure{};
  scenario.gauge.gain_uncertainty = 0.01;
  TestExperiment test(scenario, 3);
  const Measurement m = test.measure();
  const auto& top = test.twin.truth.levels.back();
  const double gain = top.label / top.pressure - 1.0;
  ASSERT_GT(std::abs(gain), 1e-3);
  const SplitJudgement split = split_errors(m, test.twin.truth);
  for (Index r = 0; r < 2; ++r) {
    const auto& stations = split.runs[static_cast<std::size_t>(r)].stations;
    for (Index i = m.x.size() / 4; i < 3 * m.x.size() / 4; ++i) {
      // The coordinate of the curves scales with the labels; lists round these to 0.1 Pa.
      EXPECT_NEAR(stations.labels[i], gain / (1.0 + gain) * m.pressure(r, i), 0.15);
    }
  }
}

TEST(SplitErrors, ReadTheSettingsOfTheResult) {
  MeasureOptions options;
  options.curves.joint_labels = false;
  options.curves.pooling = 300.0;  // 10 Pa each: levels up to 4.2 kPa apart become one
  TestExperiment test;
  Measurement m = test.measure(options);
  EXPECT_EQ(split_errors(m, test.twin.truth).runs[1].summary.n_left_out, 0);
  TestExperiment::replace_in(m.settings, "pooling = 300", "pooling = 2");
  EXPECT_GT(split_errors(m, test.twin.truth).runs[1].summary.n_left_out, 50);
}

TEST(SplitErrors, JudgeTheStretchThatIsAsked) {
  TestExperiment test;
  const Measurement m = test.measure();
  const SplitJudgement whole = split_errors(m, test.twin.truth);
  const SplitJudgement part = split_errors(m, test.twin.truth, 6.0 * mm, 8.0 * mm);
  const Flags1 inside = within(m.x, 6e-3, 8e-3);
  EXPECT_EQ(part.runs[0].summary.n_split + part.runs[0].summary.n_left_out,
            (inside != 0 && m.pressure.row(0).transpose().isFinite()).count());
  EXPECT_LT(part.runs[0].summary.n_split, whole.runs[0].summary.n_split);
  EXPECT_TRUE((part.runs[0].stations.maps == whole.runs[0].stations.maps).all());
}

TEST(SplitErrors, SayWhatTheTruthLacks) {
  TestExperiment test;
  const Measurement m = test.measure();
  twin::Truth truth = test.twin.truth;
  truth.levels[4].compliance.resize(0);
  const SplitJudgement together = split_errors(m, truth);
  EXPECT_FALSE(together.runs[0].summary.locality);
  EXPECT_GT(together.runs[0].summary.curve_shape_and_locality.rms, 0.0);
  truth.levels.pop_back();
  EXPECT_NE(split_errors(m, truth).not_offered.find("no level labelled"), std::string::npos);
  EXPECT_TRUE(split_errors(m, truth).runs.empty());
  truth.levels.clear();
  EXPECT_NE(split_errors(m, truth).not_offered.find("runs only"), std::string::npos);
}

TEST(SplitErrors, RefuseATruthThatLacksTheRun) {
  TestExperiment test;
  Measurement m = test.measure();
  m.run[1] = "other";
  EXPECT_THROW(split_errors(m, test.twin.truth), InputError);
}

}  // namespace
}  // namespace manoscope::pipeline
