#pragma once

#include <string>

#include "manoscope/pipeline/predict.hpp"

namespace manoscope::cli {

/// Drops, then p(x) and zeta(x) at a few stations, as a terminal shows them; the short one has the
/// drops alone.
std::string predictions_text(const pipeline::Predictions& predictions, bool in_short);
/// One object a flow rate, SI units.
std::string predictions_json(const pipeline::Predictions& predictions);
/// One row a flow rate and station: flow_rate_m3_s, x_m, pressure_Pa, pressure_uncertainty_Pa,
/// deflection_m, deflection_uncertainty_m (standard), flags (names joined by '|').
std::string predictions_table(const pipeline::Predictions& predictions);

}  // namespace manoscope::cli
