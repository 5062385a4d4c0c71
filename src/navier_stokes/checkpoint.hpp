#pragma once

#include <filesystem>

#include "discrete_flow.hpp"

namespace manoscope::navier_stokes {

/// How far a solution had come.
struct Progress {
  double reached =
      0.0;  ///< share of the Reynolds number up to which Newton's iteration came to rest
  bool grad_div = false;
};

/// Writes the state to a file from which any number of processes goes on.
///
/// Values stand node by node, the first axis slowest: velocities, then pressures, 0 where there is
/// no fluid. Every process writes its own planes. The file appears whole or not at all.
/// @throws InputError if it cannot be written.
template <int dim>
void write_checkpoint(const std::filesystem::path& path,
                      const typename FlowSolver<dim>::Discrete& discrete, const Progress& progress);

/// Reads it back into the state.
/// @return nothing if there is no such file, or it belongs to another problem.
/// @throws InputError if the file is damaged.
template <int dim>
std::optional<Progress> read_checkpoint(const std::filesystem::path& path,
                                        typename FlowSolver<dim>::Discrete& discrete);

}  // namespace manoscope::navier_stokes
