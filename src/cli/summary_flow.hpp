#pragma once

#include <string>

#include "manoscope/results/measurement.hpp"
#include "screen.hpp"

namespace manoscope::cli {

/// What the verdict's flow model finds besides the verdict, as an aligned table: of every run the
/// flow rate off the wall and the drop that the calibration predicts. "" where there is none.
std::string flow_findings_text(const results::Measurement& measurement, const Screen& screen);

}  // namespace manoscope::cli
