#pragma once

#include <optional>
#include <vector>

#include "manoscope/report/figures.hpp"
#include "manoscope/results/measurement.hpp"
#include "manoscope/results/write.hpp"

namespace manoscope::report {

/// One run of a measurement held against its truth, as the figures show it. Arrays have shape
/// (n_x); NaN: no number.
struct JudgedRun {
  double x_start = 0.0, x_end = 0.0;         ///< m, the stretch that is judged; NaN: none
  Array1 true_pressure;                      ///< Pa
  Array1 neighbourhood, labels, maps;        ///< Pa, parts of the error; empty: not told
  Array1 curve_shape, locality;              ///< Pa; empty: known as one sum, or not told
  Array1 curve_shape_and_locality;           ///< Pa
  double coverage_68 = 0.0, coverage = 0.0;  ///< shares of the stations in the stretch
};

// Each returns nullopt where there is nothing to show. `judged` holds the runs of the measurement,
// in its order.

/// Error of one run along x in its coverage interval, and below it the parts it is made of.
std::optional<Figure> error_of_run(const results::Measurement& measurement,
                                   const std::vector<JudgedRun>& judged, Index run);
/// Pulls of all stations in the stretches, each run with the same weight, against the normal law.
std::optional<Figure> pulls(const results::Measurement& measurement,
                            const std::vector<JudgedRun>& judged);
/// Pulls of every run along x, and the share of the runs whose interval holds the truth at each
/// station.
std::optional<Figure> pulls_along(const results::Measurement& measurement,
                                  const std::vector<JudgedRun>& judged);
/// Share of stations within their 68 % and 95 % bars, run by run.
std::optional<Figure> coverage_by_run(const results::Measurement& measurement,
                                      const std::vector<JudgedRun>& judged);

/// All of them drawn, ready for a Publication: figures/judge_error_run01.svg ... (in the order of
/// the measurement), figures/judge_pulls.svg, figures/judge_along.svg, figures/judge_coverage.svg.
///
/// @return nothing where gnuplot is not installed.
/// @throws InternalError if gnuplot does not accept a script.
std::vector<results::ExtraFile> judged_figures(const results::Measurement& measurement,
                                               const std::vector<JudgedRun>& judged);

}  // namespace manoscope::report
