#pragma once

#include <string>

#include "manoscope/results/measurement.hpp"

namespace manoscope::report {

// Parts of the page that hold numbers, each an HTML fragment; "" where there is nothing to show.

/// What was measured: channel, fluid, calibration, runs.
std::string facts_list(const results::Measurement& measurement);
/// How p(x) was read, and the tube law, in words.
std::string reading_list(const results::Measurement& measurement);
/// One row a run: Q, Re, extracted and resistance drop with expanded uncertainty, E_n and verdict,
/// transducer minus parasitic, share of the test section that was read.
std::string runs_table(const results::Measurement& measurement);
/// Share of each source in the variance of p at the middle of the test section, one row a run.
std::string budget_table(const results::Measurement& measurement);
/// a and b of the tube law, one row a run and one a level that has them.
std::string tube_law_table(const results::Measurement& measurement);
/// Tilt, noise, missing pixels and spikes, one row a map.
std::string maps_table(const results::Measurement& measurement);
/// The reading flags: name, meaning, and at how many stations each stands.
std::string flags_table(const results::Measurement& measurement);

}  // namespace manoscope::report
