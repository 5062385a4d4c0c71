#include "manoscope/validation/judge.hpp"

#include <algorithm>
#include <cmath>

#include "manoscope/core/error.hpp"

namespace manoscope::validation {

Judgement judge_reading(const Flags1& answered, const Array1& pressure, const Array1& uncertainty,
                        const Array1& lower, const Array1& upper, const Array1& truth) {
  MANO_ASSERT(answered.size() == truth.size() && pressure.size() == truth.size());
  Judgement result;
  double sum = 0.0, squares = 0.0, pull_sum = 0.0, pull_squares = 0.0;
  Index covered = 0, n_pulls = 0, n_within = 0;
  for (Index i = 0; i < truth.size(); ++i) {
    if (answered[i] == 0) {
      ++result.n_silent;
      continue;
    }
    ++result.n_answered;
    const double error = pressure[i] - truth[i];
    sum += error;
    squares += error * error;
    result.largest = std::max(result.largest, std::abs(error));
    covered += truth[i] >= lower[i] && truth[i] <= upper[i];
    if (uncertainty[i] > 0.0) {
      const double pull = error / uncertainty[i];
      pull_sum += pull;
      pull_squares += pull * pull;
      n_within += std::abs(pull) <= 1.0;
      ++n_pulls;
    }
  }
  if (result.n_answered > 0) {
    const auto n = static_cast<double>(result.n_answered);
    result.mean = sum / n;
    result.rms = std::sqrt(squares / n);
    result.coverage = static_cast<double>(covered) / n;
  }
  if (n_pulls > 0) {
    const auto n = static_cast<double>(n_pulls);
    result.pull_mean = pull_sum / n;
    result.pull_rms = std::sqrt(pull_squares / n);
    result.coverage_68 = static_cast<double>(n_within) / n;
    result.pull_width =
        std::sqrt(std::max(0.0, pull_squares / n - result.pull_mean * result.pull_mean));
  }
  return result;
}

PullSummary average_pulls(const std::vector<Judgement>& runs) {
  PullSummary summary;
  double squares = 0.0;
  for (const Judgement& run : runs) {
    if (run.n_answered == 0) continue;
    ++summary.n_runs;
    summary.pull_mean += run.pull_mean;
    squares += run.pull_rms * run.pull_rms;
    summary.coverage_68 += run.coverage_68;
    summary.coverage += run.coverage;
  }
  if (summary.n_runs == 0) return summary;
  const auto n = static_cast<double>(summary.n_runs);
  summary.pull_mean /= n;
  summary.pull_rms = std::sqrt(squares / n);
  summary.coverage_68 /= n;
  summary.coverage /= n;
  return summary;
}

}  // namespace manoscope::validation
