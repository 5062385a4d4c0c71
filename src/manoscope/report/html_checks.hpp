#pragma once

#include <string>

#include "manoscope/results/measurement.hpp"

namespace manoscope::report {

/// The part of the page on checks without truth: their lines in words, what to improve first, and
/// tables of levels left out, of the maps' cross-sections and of repeats. "" where there is
/// nothing.
std::string checks_part(const results::Measurement& measurement);

}  // namespace manoscope::report
