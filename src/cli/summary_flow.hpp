#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "manoscope/results/measurement.hpp"

namespace manoscope::cli {

/// What the verdict's flow model says of every run, as an aligned table of at most 100 columns: its
/// drop, the verdict, the flow rate off the wall, the drop that the calibration predicts. "" where
/// there is nothing to tell.
std::string flow_checks_text(const results::Measurement& measurement);
/// Of one run as JSON, SI units, standard uncertainties: verdict, models, corrections, ...
nlohmann::json flow_checks_json(const results::Measurement& measurement, Index run);

}  // namespace manoscope::cli
