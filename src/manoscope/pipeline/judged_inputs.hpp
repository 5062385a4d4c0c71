#pragma once

#include "manoscope/results/measurement.hpp"
#include "manoscope/twin/truth.hpp"

namespace manoscope::pipeline {

/// Sees that a result was measured from the maps that a truth belongs to.
///
/// Every map of Measurement::inputs must be one of Truth::inputs, by its SHA-256 whatever its name;
/// a truth may know of maps that were not measured. Nothing is compared where one of them tells of
/// no maps (a truth.csv).
/// @throws InputError naming both experiments and the first map that differs.
void check_same_inputs(const results::Measurement& measurement, const twin::Truth& truth);

}  // namespace manoscope::pipeline
