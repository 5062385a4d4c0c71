#pragma once

#include <filesystem>
#include <string>

#include "manoscope/core/monitor.hpp"
#include "manoscope/pipeline/simulate_passages.hpp"
#include "manoscope/pipeline/simulate_runs.hpp"
#include "navier_stokes/simulation_options.hpp"

namespace manoscope::cli {

/// How the solver is run, beside what it solves.
struct SolverRun {
  int processes = 1;                 ///< more than one: under mpirun
  std::filesystem::path vtu;         ///< where it writes velocity and pressure; empty: nowhere
  std::filesystem::path checkpoint;  ///< where it goes on after it was stopped; empty: nowhere

  template <class Visitor>
  void describe(Visitor&& visit) {
    visit("processes", processes, "processes of the solver; more than one run under mpirun");
  }
};

/// Asks manoscope-navier-stokes, a program of its own beside this one or on PATH, for the flow in
/// the shape of a table.
/// @return its answer, JSON.
/// @throws InputError if it is not installed, or as it says; Interrupted, the program ended.
std::string ask_solver(const std::filesystem::path& shape,
                       const navier_stokes::SimulationOptions& options, const SolverRun& run,
                       const Monitor& monitor);

/// The same for the flow in a measured shape.
/// @param options  mesh, stations and ducts before and behind; the rest is the flow's own.
pipeline::SolvedFlow solve_flow(const pipeline::GivenFlow& flow,
                                navier_stokes::SimulationOptions options, const SolverRun& run,
                                const Monitor& monitor);

/// The drop of a rigid passage, in three dimensions.
/// @param options  order, solver and tolerance; the rest is the passage's own.
pipeline::SolvedPassage solve_passage(const pipeline::GivenPassage& passage,
                                      const navier_stokes::MeshOptions& options,
                                      const SolverRun& run, const Monitor& monitor);

/// @throws InputError if the solver is not installed: before an experiment is calibrated in vain.
void require_solver();
bool has_solver();

}  // namespace manoscope::cli
