#pragma once

#include <string>

namespace manoscope::design {

/// "300 Pa", "17.5 kPa": a pressure, Pa, in words.
std::string pressure_text(double pressure);

}  // namespace manoscope::design
