#pragma once

#include "manoscope/core/arrays.hpp"

namespace manoscope::numerics {

/// Trapezoid rule over ascending nodes: integral of y over [first, last] = sum w_i y_i.
/// @param x  (n), n >= 1; one node gives weight 0.
Array1 trapezoid_weights(const Array1& x);

}  // namespace manoscope::numerics
