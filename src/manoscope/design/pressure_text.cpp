#include "manoscope/design/pressure_text.hpp"

#include <fmt/format.h>

namespace manoscope::design {

std::string pressure_text(double pressure) {
  return pressure < 1e3 ? fmt::format("{:.3g} Pa", pressure)
                        : fmt::format("{:.4g} kPa", 1e-3 * pressure);
}

}  // namespace manoscope::design
