#pragma once

#include <string>
#include <vector>

#include "manoscope/results/measurement.hpp"

namespace manoscope::report {

/// Levels read on the curves of the others, all together.
struct LeftOutSummary {
  Index n = 0;               ///< levels with a number
  double rms = 0.0;          ///< Pa
  double pull = 0.0;         ///< root mean square; NaN where no level has an uncertainty
  Index worst = -1;          ///< the level of the largest pull, or of the largest error
  double worst_error = 0.0;  ///< Pa
  double worst_pull = 0.0;
};
LeftOutSummary summarise_left_out(const results::Measurement& measurement);

/// Cross-sections of all maps against the calibrated shapes.
struct ShapeSummary {
  Index n = 0;                ///< maps with a number
  double median = 0.0;        ///< of the reduced chi-squares
  std::vector<Index> unlike;  ///< maps whose misfit is no chance (once in 10^4), worst first
  Index n_matter = 0;  ///< of those, the first ones: they could shift p by more than its usual bars
};
ShapeSummary summarise_shapes(const results::Measurement& measurement);

/// Repeats of all states together.
struct RepeatSummary {
  Index n = 0, n_maps = 0;
  double chi_square = 0.0, dof = 0.0;
};
RepeatSummary summarise_repeats(const results::Measurement& measurement);

/// The checks in words, one line each, for the terminal and the report.
std::vector<std::string> check_lines(const results::Measurement& measurement);

}  // namespace manoscope::report
