#pragma once

#include "manoscope/pipeline/read_runs.hpp"
#include "manoscope/pipeline/simulate_runs.hpp"
#include "manoscope/results/simulation.hpp"
#include "manoscope/validation/compare_simulation.hpp"

namespace manoscope::pipeline {

// Copies what was found about a simulated run into the flat arrays of its file.

/// @param outlet  Pa, gauge pressure at the channel's end.
void store_solution(const SolvedFlow& solved, double outlet, results::Simulation& simulation);

/// After store_solution(), on its stations.
void store_comparison(const validation::SimulationComparison& found,
                      results::Simulation& simulation);
void store_reading(const RunFindings& found, results::Simulation& simulation);

}  // namespace manoscope::pipeline
