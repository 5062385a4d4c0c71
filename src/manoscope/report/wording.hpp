#pragma once

#include <string>

#include "manoscope/results/measurement.hpp"

namespace manoscope::report {

/// What the stated uncertainty of Q R holds and what it takes as exact, as one sentence: "U(QR)
/// holds gap, deflection and viscosity; the flow rate counts as exact."
std::string resistance_uncertainty_text(const results::Measurement& measurement);

}  // namespace manoscope::report
