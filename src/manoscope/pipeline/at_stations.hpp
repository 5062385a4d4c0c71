#pragma once

#include "manoscope/core/arrays.hpp"
#include "manoscope/inversion/read_pressure.hpp"

namespace manoscope::pipeline {

/// Values on ascending stations, straight between them, at others; NaN outside and next to NaN.
Array1 between(const Array1& from, const Array1& values, const Array1& x);

/// The same for the stations of a reading that have an answer.
Array1 answers_between(const inversion::PressureReading& reading, const Array1& values,
                       const Array1& x);

}  // namespace manoscope::pipeline
