#include "manoscope/pipeline/judge.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "manoscope/core/error.hpp"

namespace manoscope::pipeline {
namespace {

/// Linear interpolation; the end values are held beyond the ends.
double interpolate(const Array1& x, const Array1& y, double at) {
  const auto* const begin = x.data();
  const auto* const above = std::upper_bound(begin, begin + x.size(), at);
  if (above == begin) return y[0];
  if (above == begin + x.size()) return y[y.size() - 1];
  const Index i = above - begin - 1;
  return y[i] + (at - x[i]) / (x[i + 1] - x[i]) * (y[i + 1] - y[i]);
}

const twin::RunTruth& find_truth(const twin::Truth& truth, const std::string& run) {
  for (const twin::RunTruth& candidate : truth.runs) {
    if (candidate.run == run) return candidate;
  }
  throw InputError("truth", fmt::format("holds no run \"{}\"", run),
                   "Give the truth of the same experiment");
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
    result.x_start = start ? start->si() : m.test_section(r, 0);
    result.x_end = end ? end->si() : m.test_section(r, 1);
    std::vector<Index> stations;
    if (!std::isnan(result.x_start) && !std::isnan(result.x_end)) {
      for (Index ix = 0; ix < m.x.size(); ++ix) {
        if (m.x[ix] >= result.x_start && m.x[ix] <= result.x_end) stations.push_back(ix);
      }
    }
    Flags1 answered = Flags1::Zero(m.x.size());
    Array1 expected(m.x.size());
    for (Index ix = 0; ix < m.x.size(); ++ix) {
      expected[ix] = interpolate(truth.x, run.pressure, m.x[ix]);
    }
    for (const Index ix : stations) answered[ix] = std::isnan(m.pressure(r, ix)) ? 0 : 1;
    result.reading =
        validation::judge_reading(answered, m.pressure.row(r), m.pressure_uncertainty.row(r),
                                  m.pressure_lower.row(r), m.pressure_upper.row(r), expected);
    result.reading.n_silent = static_cast<Index>(stations.size()) - result.reading.n_answered;
    judge_drop(m, r, answered, expected, result);
    results.push_back(std::move(result));
  }
  return results;
}

}  // namespace manoscope::pipeline
