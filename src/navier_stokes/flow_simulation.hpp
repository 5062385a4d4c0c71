#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "flow_solver.hpp"
#include "manoscope/core/arrays.hpp"
#include "manoscope/core/monitor.hpp"
#include "manoscope/core/units.hpp"
#include "manoscope/flow/channel.hpp"
#include "manoscope/flow/marching.hpp"
#include "simulation_options.hpp"

namespace manoscope::navier_stokes {

/// A channel whose wall stands still in a given shape, and the flow through it.
///
/// x runs from 0 to channel.length; the gap is height + zeta(x, z). Rigid straight ducts of gap
/// `height` may lie before and behind.
struct SimulatedChannel {
  flow::Channel channel;
  /// Deflection, m, for x and z in m; in three dimensions even in z and asked for z >= 0 alone, in
  /// two width-averaged and asked for z = 0. Asked from several threads at once.
  std::function<double(double x, double z)> zeta;
  flow::Fluid fluid{1.0 * mPa_s, 998.0 * kg_per_m3};
  FlowRate flow_rate{};
  Length lead_in{}, lead_out{};
  bool lead_in_slips = false;  ///< walls of the lead-in without friction: a uniform flow stays so
  flow::InletProfile inlet = flow::InletProfile::developed;  ///< where the mesh begins
};

/// What Navier-Stokes makes of it. Arrays are (stations), SI, p = 0 in the mean at x = length.
struct SimulatedFlow {
  int dim = 2;
  Array1 x, gap;                ///< gap at z = 0
  Array1 mean_pressure;         ///< over the section
  Array1 coarse_mean_pressure;  ///< the same on the coarser mesh
  Array1 wall_pressure;         ///< on the roof at z = 0
  Array1 floor_pressure;        ///< on the floor at z = 0
  Array1 wall_shear;            ///< on the roof at z = 0, > 0 with the flow
  Array1 floor_shear;           ///< on the floor at z = 0
  Array1 mean_pressure_uncertainty, wall_pressure_uncertainty;  ///< numerical, k = 1
  double drop = 0.0;              ///< Pa: mean pressure at x = 0 less that at x = length
  double drop_uncertainty = 0.0;  ///< Pa: numerical, k = 1
  double coarse_drop = 0.0;       ///< Pa: on the coarser mesh
  double roof_misfit = 0.0;       ///< RoofMisfit::share of the finer mesh
  bool converged = false;         ///< drop_uncertainty is within the tolerance asked for
  double reynolds = 0.0;          ///< on the hydraulic diameter of the undeflected channel
  FlowCosts costs;                ///< of both meshes; unknowns of the finer
};

/// Files beside the answer; "" none.
struct SimulationFiles {
  std::filesystem::path vtu;  ///< the finer mesh's velocity and pressure for ParaView
  /// Where a run that was stopped goes on, with ".coarse" behind it for the coarser mesh; both are
  /// removed at the end.
  std::filesystem::path checkpoint;
};

/// Solves the steady laminar flow of an incompressible fluid on two meshes.
///
/// FlowSolver on a mesh of the cells asked for, and on one with two thirds of them, rounded, along
/// each axis. The numerical uncertainty of a value is uncertainty_of_difference() of both, for an
/// error that falls with the first power of the size of the cells: twice the difference where all
/// axes have two thirds, three times where one has 4 cells and 3. Smooth flow converges with the
/// fourth power, to which u leaves a factor of 8; the corners where a roof leaves the rim with a
/// slope take the drop down to about the first. On the reference flows of docs/simulation.md the
/// error of the drop is within 2 u (tests).
///
/// Boundary conditions: where the mesh begins, a developed profile (2-D a parabola, 3-D that of
/// the duct below the roof there) or a uniform one, v = w = 0, scaled to the flow rate; no slip;
/// du/dn = p n where the mesh ends. In 3-D half the channel, symmetric about z = 0, is solved.
///
/// Validity: laminar, steady. Near x = 0 and x = length, where a roof leaves the rim with a slope,
/// and at the edge of a uniform inlet, the pressure on the wall itself is not finite: values there
/// depend on the mesh, as their uncertainties show; the section mean is finite.
///
/// @param stations  (n) x, m, in [0, length].
/// @param files     what else it writes.
/// @throws InputError for what is out of range, a gap that closes, a roof that the cells do not
///         follow within 5 % of the gap, or if no steady flow is found.
SimulatedFlow simulate(const SimulatedChannel& channel, const Array1& stations,
                       const MeshOptions& mesh, const SimulationFiles& files = {},
                       const Monitor& monitor = {});

}  // namespace manoscope::navier_stokes
