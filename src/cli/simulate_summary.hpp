#pragma once

#include <optional>
#include <string>
#include <vector>

#include "manoscope/core/error.hpp"

namespace manoscope::cli {

/// The fault that the solver found in its input, nullopt if it found none.
/// @param answer  what it wrote: a line with an object of results, or of an error; of several
///                processes lines.
std::optional<InputError> simulation_fault(const std::string& answer);
/// The fault of its own that it tells, nullopt if it tells none.
std::optional<std::string> solver_fault(const std::string& answer);

/// Drop with its numerical uncertainty and p(x) at a few stations, as a terminal shows them; the
/// short one has the drop alone.
std::string simulation_text(const std::string& answer, bool in_short);

/// What speaks against the answer: Re beyond laminar flow, a drop that is not converged.
std::vector<std::string> simulation_doubts(const std::string& answer);

/// One row a station: x_m, gap_m, pressures (Pa) with their standard numerical uncertainty, wall
/// shears (Pa).
std::string simulation_table(const std::string& answer);

}  // namespace manoscope::cli
