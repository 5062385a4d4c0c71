#pragma once

#include <string>

#include "manoscope/core/units.hpp"

/// Values as the TOML files of this module write them.
namespace manoscope::twin::toml_text {

/// "0.175 mm" in quotes. Ten digits: shorter than round-trip, so that 0.175 mm reads as 175 um.
std::string in_unit(double number, const char* unit);
/// In the unit of Pa to GPa, or pm to mm, in which the number is below 1000.
std::string best(Pressure pressure);
std::string best(Length length);

}  // namespace manoscope::twin::toml_text
