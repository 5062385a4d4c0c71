#include "manoscope/flow/channel.hpp"

#include <fmt/format.h>

#include <cmath>

#include "manoscope/core/error.hpp"

namespace manoscope::flow {
namespace {

void require_positive(double value, const char* name, const char* unit, const char* example,
                      const std::string& where) {
  if (value > 0.0 && std::isfinite(value)) return;
  throw InputError(where, fmt::format("{} is {:g} {}", name, value, unit),
                   fmt::format("Give a positive {} such as \"{}\"", name, example));
}

}  // namespace

void Channel::validate(const std::string& where) const {
  require_positive(length.si(), "channel length", "m", "15.5 mm", where);
  require_positive(width.si(), "channel width", "m", "1.7 mm", where);
  require_positive(height.si(), "channel height", "m", "175 um", where);
}

void Fluid::validate(const std::string& where) const {
  require_positive(viscosity.si(), "viscosity", "Pa s", "1.0 mPa s", where);
  require_positive(density.si(), "density", "kg/m3", "998 kg/m3", where);
}

}  // namespace manoscope::flow
