#pragma once

#include <string>
#include <vector>

#include "manoscope/results/simulation.hpp"

namespace manoscope::results {

/// One row a run and station, with the conventions of pressure_table().
///
/// Columns: run, dim, flow_rate_m3_s, x_m, deflection_m, deflection_uncertainty_m, gap_m,
/// mean_pressure_Pa and its uncertainty as solved, the same with side walls (empty in three
/// dimensions), read_pressure_Pa and its uncertainty, inlet_effect_Pa, wall and floor pressure,
/// wall and floor shear; then uncertainty_by_<part>_Pa. Uncertainties are standard, k = 1.
/// @param simulations  with the same parts of the uncertainty.
std::string simulations_table(const std::vector<Simulation>& simulations);

}  // namespace manoscope::results
