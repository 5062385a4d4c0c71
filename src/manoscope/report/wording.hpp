#pragma once

#include <string>

#include "manoscope/results/measurement.hpp"

namespace manoscope::report {

/// What the stated uncertainty of Q R holds, what it takes as exact and what it leaves out, as one
/// sentence: "U(QR) holds gap, deflection and viscosity; the flow rate counts as exact."
std::string resistance_uncertainty_text(const results::Measurement& measurement);

/// Whether dp_e and QR differ by no more than the bars of both, eq. (4) itself taken as exact:
/// "within U", "beyond U", "no verdict". No verdict on the formula, which is flow_verdict().
const char* resistance_word(double en_number);

/// Names the runs whose section march broke down, as a sentence behind others; "" if none.
std::string broken_marches_text(const results::Measurement& measurement);

}  // namespace manoscope::report
