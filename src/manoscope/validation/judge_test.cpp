#include "manoscope/validation/judge.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "manoscope/core/random.hpp"

namespace manoscope::validation {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

template <class... T>
Array1 array(T... values) {
  Array1 result(sizeof...(values));
  Index i = 0;
  ((result[i++] = values), ...);
  return result;
}

Flags1 all(Index n) { return Flags1::Ones(n); }

TEST(JudgeReading, CountsErrorsPullsAndCoverageOfKnownNumbers) {
  // Errors 3, -4, 0, 5 Pa; pulls 1.5, -1, 0, 1; the third interval misses nothing, the last does.
  const Array1 truth = array(100.0, 100.0, 100.0, 100.0), p = array(103.0, 96.0, 100.0, 105.0);
  const Array1 u = array(2.0, 4.0, 1.0, 5.0);
  const Array1 lower = array(99.0, 92.0, 100.0, 101.0), upper = array(107.0, 100.0, 100.0, 109.0);
  const Judgement found = judge_reading(all(4), p, u, lower, upper, truth);
  EXPECT_EQ(found.n_answered, 4);
  EXPECT_EQ(found.n_silent, 0);
  EXPECT_DOUBLE_EQ(found.mean, 1.0);
  EXPECT_DOUBLE_EQ(found.rms, std::sqrt(50.0 / 4.0));
  EXPECT_DOUBLE_EQ(found.largest, 5.0);
  EXPECT_DOUBLE_EQ(found.pull_mean, 1.5 / 4.0);
  EXPECT_DOUBLE_EQ(found.pull_width, std::sqrt(4.25 / 4.0 - 0.375 * 0.375));
  EXPECT_DOUBLE_EQ(found.coverage, 0.75);  // an end of the interval belongs to it
  EXPECT_DOUBLE_EQ(found.pull_rms, std::sqrt(4.25 / 4.0));
  EXPECT_DOUBLE_EQ(found.coverage_68, 0.75);  // all but the first
}

TEST(JudgeReading, LeavesOutSilentStationsWhateverTheyHold) {
  Flags1 answered = all(4);
  answered[1] = answered[3] = 0;
  const Array1 truth = array(10.0, 20.0, 30.0, 40.0);
  // Quiet NaN traps in a comparison: nothing may look at a silent station.
  const Array1 p = array(11.0, kNan, 29.0, kNan), u = array(1.0, kNan, 1.0, 0.0);
  const Judgement found = judge_reading(answered, p, u, p - 2.0, p + 2.0, truth);
  EXPECT_EQ(found.n_answered, 2);
  EXPECT_EQ(found.n_silent, 2);
  EXPECT_DOUBLE_EQ(found.rms, 1.0);
  EXPECT_DOUBLE_EQ(found.mean, 0.0);
  EXPECT_DOUBLE_EQ(found.coverage, 1.0);
}

TEST(JudgeReading, HasNoPullWhereNoUncertaintyIsStated) {
  const Array1 truth = array(10.0, 20.0), p = array(11.0, 26.0), u = array(0.0, 3.0);
  const Judgement found = judge_reading(all(2), p, u, p - u, p + u, truth);
  EXPECT_DOUBLE_EQ(found.pull_mean, 2.0);
  EXPECT_DOUBLE_EQ(found.pull_width, 0.0);
  EXPECT_DOUBLE_EQ(found.mean, 3.5);  // its error still counts
  EXPECT_DOUBLE_EQ(found.coverage, 0.0);
}

TEST(JudgeReading, OfASilentRunIsZeroThroughout) {
  const Array1 nothing = Array1::Constant(3, kNan);
  const Judgement found =
      judge_reading(Flags1::Zero(3), nothing, nothing, nothing, nothing, Array1::Zero(3));
  EXPECT_EQ(found.n_answered, 0);
  EXPECT_EQ(found.n_silent, 3);
  EXPECT_EQ(found.rms, 0.0);
  EXPECT_EQ(found.coverage, 0.0);
}

TEST(JudgeReading, FindsTrueErrorBarsTrue) {
  constexpr Index kN = 20000;
  RandomStream stream(5, "judge");
  Array1 truth(kN), p(kN), u(kN);
  for (Index i = 0; i < kN; ++i) {
    truth[i] = stream.uniform(0.0, 1e4);
    u[i] = stream.uniform(1.0, 20.0);
    p[i] = truth[i] + u[i] * stream.normal();
  }
  const Judgement found =
      judge_reading(all(kN), p, u, p - 1.959963985 * u, p + 1.959963985 * u, truth);
  // Sampling errors of 20000 independent pulls: 0.0071, 0.0050 and 0.0015; four of each.
  EXPECT_NEAR(found.pull_mean, 0.0, 4.0 * 0.0071);
  EXPECT_NEAR(found.pull_width, 1.0, 4.0 * 0.0050);
  EXPECT_NEAR(found.pull_rms, 1.0, 4.0 * 0.0050);
  EXPECT_NEAR(found.coverage, 0.95, 4.0 * 0.0015);
  EXPECT_NEAR(found.coverage_68, 0.6827, 4.0 * 0.0033);
}

TEST(AveragePulls, WeighsEachRunTheSameAndLeavesOutTheSilent) {
  Judgement one, other, silent;
  one.n_answered = 10;
  one.pull_mean = one.pull_rms = 2.0;
  other.n_answered = 1000;
  other.pull_mean = -1.0;
  other.pull_rms = 1.0;
  other.coverage = other.coverage_68 = 1.0;
  silent.pull_mean = 77.0;
  const PullSummary found = average_pulls({one, silent, other});
  EXPECT_EQ(found.n_runs, 2);
  EXPECT_DOUBLE_EQ(found.pull_mean, 0.5);
  EXPECT_DOUBLE_EQ(found.pull_rms, std::sqrt(2.5));
  EXPECT_DOUBLE_EQ(found.coverage, 0.5);
  EXPECT_DOUBLE_EQ(found.coverage_68, 0.5);
  EXPECT_EQ(average_pulls({}).n_runs, 0);
}

TEST(AveragePulls, SeesTheOffsetThatTheStationsOfARunShare) {
  // Fifty runs of 100 stations whose error is all one shared offset of width 1.
  RandomStream stream(6, "judge");
  std::vector<Judgement> runs;
  double width = 0.0;
  for (int r = 0; r < 50; ++r) {
    const Array1 truth = Array1::Zero(100), u = Array1::Ones(100);
    const Array1 p = Array1::Constant(100, stream.normal());
    runs.push_back(judge_reading(all(100), p, u, p - 1.96 * u, p + 1.96 * u, truth));
    width += runs.back().pull_width / 50.0;
  }
  const PullSummary found = average_pulls(runs);
  EXPECT_LT(width, 1e-7);                       // each run alone seems sure of itself
  EXPECT_NEAR(found.pull_rms, 1.0, 4.0 * 0.1);  // 1/sqrt(2 * 50)
}

}  // namespace
}  // namespace manoscope::validation
