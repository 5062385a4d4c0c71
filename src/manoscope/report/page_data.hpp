#pragma once

#include <string>

#include "manoscope/results/measurement.hpp"

namespace manoscope::report {

/// What the scripts of report.html know of a measurement: one JSON object, SI units, numbers to six
/// digits, null where there is none; bytes that are no UTF-8 are replaced. Maps stand beside it.
/// Both travel packed (packed.hpp), so that no text of the user's can end the element that holds
/// it.
std::string page_data(const results::Measurement& measurement);

}  // namespace manoscope::report
