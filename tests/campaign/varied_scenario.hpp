// Experiments nobody has seen: the shipped scenarios with other walls, levels, flows and cameras.
#pragma once

#include <cstdint>
#include <string>

#include "manoscope/twin/scenario.hpp"

namespace manoscope::campaign {

/// A shipped scenario as another laboratory might have it.
///
/// Number 0 is the shipped one. The others have a wall of other modulus, thickness, prestress and
/// preload, 14 to 30 levels, six flow rates, gauges of 1 to 20 Pa, pixels of 10 to 40 nm that
/// neighbours may share in part, and a camera of 512, 768 or 1024 pixels along the flow.
///
/// @param base  name of a shipped scenario.
twin::Scenario varied_scenario(const std::string& base, std::uint64_t number);

}  // namespace manoscope::campaign
