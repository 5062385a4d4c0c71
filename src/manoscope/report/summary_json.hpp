#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "manoscope/results/measurement.hpp"

namespace manoscope::report {

/// A measurement in short, SI units, standard uncertainties: of every run what drops.csv holds and
/// what the flow models say, the checks without truth, what to improve first, warnings.
/// @param folder  of the result, told as "output".
nlohmann::json summary_json(const results::Measurement& measurement, const std::string& folder);

}  // namespace manoscope::report
