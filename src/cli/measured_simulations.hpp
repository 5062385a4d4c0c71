#pragma once

#include <string>
#include <vector>

#include "manoscope/results/simulation.hpp"
#include "navier_stokes/simulation_options.hpp"

namespace manoscope::cli {

/// Simulated and read drop of every run over the test section; unless `in_short`, how the shape was
/// taken, what the bars are made of and p(x) at a few stations as well.
std::string simulations_text(const std::vector<results::Simulation>& simulations, bool in_short);

/// The same as JSON, SI units, standard uncertainties, every station.
/// @param one  an object instead of a list of one.
std::string simulations_json(const std::vector<results::Simulation>& simulations, bool one);

/// Options of mesh and stations, one a line: what the file of a simulation keeps.
std::string solver_settings(const navier_stokes::SimulationOptions& options);

}  // namespace manoscope::cli
