#pragma once

#include <string>
#include <vector>

#include "manoscope/inversion/station_stiffness.hpp"
#include "manoscope/inversion/tube_law.hpp"
#include "manoscope/pipeline/assemble.hpp"
#include "manoscope/results/measurement.hpp"

namespace manoscope::pipeline {

/// Copies what was found of the tube law into the arrays of the result file, and says it in words.
///
/// @param m  with run names, channel width and half-response wavelengths already stored.
void store_tube_law(const inversion::TubeLawAtRest& at_rest,
                    const inversion::StationStiffness& stiffness,
                    const std::vector<RunFindings>& findings, results::Measurement& m);

/// The law in words, from the arrays of a result: b of the runs of least and of most deflection and
/// how far it is from 0, the healing length beside that of the fitted wall, and what the ends say.
///
/// @param why  what there is to say where no run, or no level, has a law.
struct NoTubeLaw {
  std::string under_flow, at_rest;
};
std::string tube_law_text(const results::Measurement& m, const NoTubeLaw& why);

}  // namespace manoscope::pipeline
