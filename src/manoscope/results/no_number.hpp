#pragma once

#include <limits>

namespace manoscope::results {

/// A number that does not exist.
inline constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();

}  // namespace manoscope::results
