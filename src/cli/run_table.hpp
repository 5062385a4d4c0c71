#pragma once

#include <string>

#include "manoscope/results/measurement.hpp"
#include "screen.hpp"

namespace manoscope::cli {

/// Every run of a measurement in a line: flow rate, drop over the test section off the wall and by
/// the flow model, both with expanded uncertainty (k = 2), verdict; below it what the words mean.
///
/// Where no flow model was run, eq. (4) stands for it, and the verdict takes it as exact. A
/// terminal that is too narrow gets fewer columns: E_n goes first, then the flow rate, then the
/// flow's drop.
std::string run_table(const results::Measurement& measurement, const Screen& screen);

}  // namespace manoscope::cli
