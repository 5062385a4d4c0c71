#pragma once

#include <vector>

#include "manoscope/results/schema.hpp"

// Parts of the schema, in the order of the file, after the channel, the calibration and the
// reading.

namespace manoscope::results {

std::vector<Dimension> flow_dimensions();
std::vector<Variable> flow_variables();  ///< of FlowChecks

std::vector<Variable> tube_law_variables();

std::vector<Dimension> map_dimensions();
std::vector<Variable> map_variables();  ///< what each map was like

std::vector<Dimension> check_dimensions();
std::vector<Variable> check_variables();  ///< of Checks

}  // namespace manoscope::results
