#pragma once

#include <string>

#include "manoscope/results/measurement.hpp"
#include "screen.hpp"

namespace manoscope::cli {

/// What the measurement tells of itself without truth, and what to improve first; "" where there is
/// nothing to tell.
std::string checks_text(const results::Measurement& measurement, const Screen& screen);

}  // namespace manoscope::cli
