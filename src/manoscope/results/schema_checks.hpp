#pragma once

#include <vector>

#include "manoscope/results/schema.hpp"

namespace manoscope::results {

/// The part of the schema that holds the Checks, after all others.
std::vector<Dimension> check_dimensions();
std::vector<Variable> check_variables();

}  // namespace manoscope::results
