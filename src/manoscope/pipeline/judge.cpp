#include "manoscope/pipeline/judge.hpp"

#include <cmath>

#include "manoscope/pipeline/judged_stretch.hpp"

namespace manoscope::pipeline {
namespace {

constexpr double kNormal95 = 1.959964;  // quantile of the normal law

Index count(const Flags1& flags) { return (flags != 0).count(); }

/// A deflection against its truth; its interval is 1.96 standard uncertainties either way.
validation::Judgement judge_deflection(const Flags1& inside, const Array1& deflection,
                                       const Array1& uncertainty, const Array1& truth) {
  const Array1 half = kNormal95 * uncertainty;
  auto result = validation::judge_reading(answers(inside, deflection), deflection, uncertainty,
                                          deflection - half, deflection + half, truth);
  result.n_silent = count(inside) - result.n_answered;
  return result;
}

/// Drop between the outermost answered stations of the stretch, and its error.
void judge_drop(const results::Measurement& m, Index run, const Flags1& answered,
                const Array1& truth, RunJudgement& result) {
  Index first = 0, last = answered.size() - 1;
  while (first < last && answered[first] == 0) ++first;
  while (last > first && answered[last] == 0) --last;
  if (first == last) return;
  const Array1 pressure = m.pressure.row(run);
  result.true_drop = truth[first] - truth[last];
  result.drop_error = pressure[first] - pressure[last] - result.true_drop;
  const Matrix& covariance = m.pressure_covariance[static_cast<std::size_t>(run)];
  const double variance =
      covariance(first, first) + covariance(last, last) - 2.0 * covariance(first, last);
  if (variance > 0.0) result.drop_pull = result.drop_error / std::sqrt(variance);
}

}  // namespace

std::vector<RunJudgement> judge(const results::Measurement& m, const twin::Truth& truth,
                                std::optional<Length> start, std::optional<Length> end) {
  std::vector<RunJudgement> results;
  for (Index r = 0; r < m.flow_rate.size(); ++r) {
    const twin::RunTruth& run = find_truth(truth, m.run[static_cast<std::size_t>(r)]);
    RunJudgement result;
    result.run = run.run;
    const auto [x_start, x_end] = judged_stretch(m, r, start, end);
    result.x_start = x_start;
    result.x_end = x_end;
    const Array1 expected = interpolate(truth.x, run.pressure, m.x);
    const Array1 pressure = m.pressure.row(r);
    const Flags1 inside = within(m.x, x_start, x_end);
    const Flags1 answered = answers(inside, pressure);
    result.reading =
        validation::judge_reading(answered, pressure, m.pressure_uncertainty.row(r),
                                  m.pressure_lower.row(r), m.pressure_upper.row(r), expected);
    result.reading.n_silent = count(inside) - result.reading.n_answered;
    result.deflection =
        judge_deflection(inside, m.deflection.row(r), m.deflection_uncertainty.row(r),
                         interpolate(truth.x, run.deflection, m.x));
    judge_drop(m, r, answered, expected, result);
    results.push_back(std::move(result));
  }
  return results;
}

std::vector<LevelJudgement> judge_levels(const results::Measurement& m, const twin::Truth& truth,
                                         std::optional<Length> start, std::optional<Length> end) {
  const Flags1 inside = within(m.x, start ? start->si() : 0.0, end ? end->si() : m.channel_length);
  std::vector<LevelJudgement> results;
  for (Index k = 0; k < m.level_pressure.size(); ++k) {
    for (const twin::LevelTruth& level : truth.levels) {
      if (!(std::abs(level.label.si() - m.level_pressure[k]) < kSameLabel)) continue;
      results.push_back(
          {m.level_pressure[k], judge_deflection(inside, m.static_deflection.row(k),
                                                 m.static_deflection_uncertainty.row(k),
                                                 interpolate(truth.x, level.deflection, m.x))});
      break;
    }
  }
  return results;
}

}  // namespace manoscope::pipeline
