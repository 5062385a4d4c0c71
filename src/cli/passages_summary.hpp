#pragma once

#include <string>
#include <vector>

#include "manoscope/pipeline/simulate_passages.hpp"

namespace manoscope::cli {

/// Drops of inlet and outlet passage at every flow rate, beside what the formulas say, and, unless
/// `in_short`, the lines for the experiment file.
std::string passages_text(const std::vector<pipeline::ParasiticDrop>& drops, bool in_short);

/// The same as JSON, SI units, standard uncertainties.
std::string passages_json(const std::vector<pipeline::ParasiticDrop>& drops);

}  // namespace manoscope::cli
