#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "manoscope/results/measurement.hpp"
#include "manoscope/twin/virtual_experiment.hpp"
#include "screen.hpp"

namespace manoscope::cli {

/// The runs of a measurement as one table.
std::string summary_text(const results::Measurement& measurement, const Screen& screen);
/// What stands behind it, as aligned tables with expanded uncertainty (k = 2): p(x) of every run at
/// a few stations, its drop by eq. (4), what its flow model finds; the tube law. An empty line
/// after each.
std::string details_text(const results::Measurement& measurement, const Screen& screen);
/// The runs as JSON, SI units: what drops.csv holds, checks, and what to improve first.
std::string summary_json(const results::Measurement& measurement,
                         const std::filesystem::path& folder);

/// A virtual experiment that was written: its runs as a table, and as JSON in SI units.
std::string twin_text(const twin::VirtualExperiment& made, const std::filesystem::path& folder);
std::string twin_json(const twin::VirtualExperiment& made, const std::filesystem::path& folder);

/// The scenarios that ship.
std::string scenarios_text();
std::string scenarios_json();

}  // namespace manoscope::cli
