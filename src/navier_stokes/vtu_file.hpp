#pragma once

#include <array>
#include <filesystem>
#include <vector>

#include "flow_solver.hpp"

namespace manoscope::navier_stokes {

/// From the units of a FlowProblem to SI.
struct VtuScales {
  double length = 1.0;         ///< m
  double velocity = 1.0;       ///< m/s
  double pressure = 1.0;       ///< Pa
  double zero_pressure = 0.0;  ///< pressure that is 0 in the file, in units of the problem
};

/// Writes a solved flow as a VTK unstructured grid (.vtu), in SI, for ParaView and VTK.
///
/// Every cell is cut into `order` parts along each axis, corners hold velocity (m/s) and pressure
/// (Pa). In three dimensions that is the half z >= 0. Of several processes each writes its piece,
/// NAME_0.vtu, NAME_1.vtu and so on, and the first NAME.pvtu, which names them.
/// @return the file to open.
/// @throws InputError if a file cannot be written.
template <int dim>
std::filesystem::path write_vtu(const std::filesystem::path& path, const FlowSolver<dim>& solver,
                                const VtuScales& scales);

}  // namespace manoscope::navier_stokes
