#pragma once

#include <filesystem>
#include <string>

#include "manoscope/core/monitor.hpp"
#include "manoscope/pipeline/simulate_passages.hpp"
#include "manoscope/pipeline/simulate_runs.hpp"
#include "navier_stokes/simulation_options.hpp"

namespace manoscope::cli {

/// Asks manoscope-navier-stokes, a program of its own beside this one or on PATH, for the flow in
/// the shape of a table.
/// @param vtu  where it writes velocity and pressure; empty: nowhere.
/// @return its answer, JSON.
/// @throws InputError if it is not installed, or as it says; Interrupted, the program ended.
std::string ask_solver(const std::filesystem::path& shape,
                       const navier_stokes::SimulationOptions& options,
                       const std::filesystem::path& vtu, const Monitor& monitor);

/// The same for the flow in a measured shape.
/// @param options  mesh, stations and ducts before and behind; the rest is the flow's own.
pipeline::SolvedFlow solve_flow(const pipeline::GivenFlow& flow,
                                navier_stokes::SimulationOptions options,
                                const std::filesystem::path& vtu, const Monitor& monitor);

/// The drop of a rigid passage, in three dimensions.
/// @param options  order, solver and tolerance; the rest is the passage's own.
pipeline::SolvedPassage solve_passage(const pipeline::GivenPassage& passage,
                                      const navier_stokes::MeshOptions& options,
                                      const Monitor& monitor);

/// @throws InputError if the solver is not installed: before an experiment is calibrated in vain.
void require_solver();

}  // namespace manoscope::cli
