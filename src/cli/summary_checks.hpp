#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "manoscope/results/measurement.hpp"
#include "screen.hpp"

namespace manoscope::cli {

/// What the measurement tells of itself without truth, and what to improve first; "" where there is
/// nothing to tell.
std::string checks_text(const results::Measurement& measurement, const Screen& screen);
/// The same as JSON, SI units: {"left_out": ..., "shapes": ..., "repeats": ...}.
nlohmann::json checks_json(const results::Measurement& measurement);
/// {"pressure": ..., "extracted_drop": ...}; null where there is nothing to tell.
nlohmann::json advice_json(const results::Measurement& measurement);

}  // namespace manoscope::cli
