#pragma once

#include <vector>

#include "manoscope/core/arrays.hpp"

namespace manoscope::validation {

/// Errors of a reading against a known truth, over the stations that have an answer.
///
/// A pull is (value - truth) / standard uncertainty: mean 0 and width 1 where error bars are true.
/// The errors of neighbouring stations are correlated, so that one run's pulls scatter far more
/// than as many independent ones; only many experiments together judge the bars.
struct Judgement {
  Index n_answered = 0, n_silent = 0;  ///< stations with and without an answer
  double rms = 0.0, largest = 0.0;     ///< Pa, of the error
  double mean = 0.0;                   ///< Pa, mean error
  double pull_mean = 0.0, pull_width = 0.0;
  double pull_rms = 0.0;     ///< root mean square about 0: offsets count
  double coverage_68 = 0.0;  ///< share within one standard uncertainty of the truth; 68.3 % is fair
  double coverage = 0.0;     ///< share of stations whose interval holds the truth
};

/// Pulls and coverage of several runs together, each run with the same weight.
///
/// The stations of a run share the errors of labels and maps, so that its pulls lie to one side
/// together: pull_width of a run is too small and its coverage all or nothing. The rms of the pulls
/// about 0 over many runs is what should be 1; the runs of one experiment still share its
/// calibration.
struct PullSummary {
  Index n_runs = 0;  ///< with an answer
  double pull_mean = 0.0, pull_rms = 0.0, coverage_68 = 0.0, coverage = 0.0;
};
PullSummary average_pulls(const std::vector<Judgement>& runs);

/// Units are those of a pressure here; a deflection may be judged as well, in m throughout.
///
/// @param answered  (n), 1 where the reading counts.
/// @param pressure, uncertainty, lower, upper  (n) Pa.
/// @param truth  (n) Pa, at the same stations.
Judgement judge_reading(const Flags1& answered, const Array1& pressure, const Array1& uncertainty,
                        const Array1& lower, const Array1& upper, const Array1& truth);

}  // namespace manoscope::validation
