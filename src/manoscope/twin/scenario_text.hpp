#pragma once

#include <string>

#include "manoscope/twin/scenario.hpp"

namespace manoscope::twin {

/// A scenario as the TOML that parse_scenario() reads, every value with its unit, options with
/// defaults included; ten digits of each.
///
/// @param comment  lines that stand in front, without their "#"; may be empty.
std::string scenario_toml(const Scenario& scenario, const std::string& comment = {});

}  // namespace manoscope::twin
