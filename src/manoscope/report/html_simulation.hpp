#pragma once

#include <string>

#include "manoscope/results/measurement.hpp"

namespace manoscope::report {

// Navier-Stokes simulations that were kept beside the result, as HTML fragments; "" without any.

/// Heads of their columns in the table of flow models, and the cells of one run under them.
std::string simulation_heads(const results::Measurement& measurement);
std::string simulation_cells(const results::Measurement& measurement, Index run);

/// A table of their own: drop against reading, what it is uncertain by, how the wall was taken.
std::string simulations_table(const results::Measurement& measurement);

}  // namespace manoscope::report
