#pragma once

#include <vector>

#include "manoscope/core/arrays.hpp"
#include "manoscope/core/units.hpp"

namespace manoscope::validation {

// What a smoothing spline along a channel must know of the clamped ends of the wall.

/// One knot at each position and one beyond each end: a wall may bend most where it is clamped.
Array1 knots_at(const Array1& positions);

/// How much more the wall may bend at its clamped ends than in between, which it does within w/pi:
/// factors of 1, 11, 101, 1001 there.
/// @param x  (n) m, from one end to the other.
std::vector<Array1> end_bends(const Array1& x, Length width);

}  // namespace manoscope::validation
