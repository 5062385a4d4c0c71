#pragma once

#include <string>
#include <vector>

#include "manoscope/report/number_text.hpp"
#include "manoscope/results/measurement.hpp"

namespace manoscope::report {

/// Largest magnitude; 0 if there is no finite one.
double largest_magnitude(const Array2& values);
double largest_magnitude(const Array1& values);

/// part / whole; NaN of a whole that is 0 or not known.
double share_of(double part, double whole);

/// Indices of the runs by ascending flow rate (runs without one are left out).
std::vector<Index> runs_by_flow_rate(const results::Measurement& measurement);

/// At most `most` of the indices, evenly spread, first and last included.
std::vector<Index> spread(const std::vector<Index>& indices, std::size_t most);

/// Values of a list at the given indices.
Array1 at(const Array1& values, const std::vector<Index>& indices);

/// Units that the whole report shows its numbers in.
struct ReportUnits {
  DisplayUnit x, deflection, pressure, drop, flow_rate;
};
ReportUnits report_units(const results::Measurement& measurement);

/// "70 mL/min" of one run.
std::string flow_rate_label(const results::Measurement& measurement, Index run,
                            const ReportUnits& units);

/// Settings that all figures share: ticks, fonts, key above the plot.
std::string common_settings();

}  // namespace manoscope::report
