#pragma once

#include <nlohmann/json_fwd.hpp>

#include "manoscope/core/arrays.hpp"

namespace manoscope::cli {

/// A number as JSON; null where it is not finite.
nlohmann::json number(double value);
/// Each of them as `number` gives it.
nlohmann::json numbers(const Array1& values);

}  // namespace manoscope::cli
