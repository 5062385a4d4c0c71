#pragma once

#include <functional>
#include <string>
#include <vector>

#include "manoscope/core/monitor.hpp"
#include "manoscope/experiment/experiment.hpp"
#include "manoscope/flow/channel.hpp"
#include "manoscope/flow/marching.hpp"
#include "manoscope/flow/roof.hpp"
#include "manoscope/pipeline/measure_options.hpp"
#include "manoscope/pipeline/read_runs.hpp"
#include "manoscope/pipeline/roof_of_run.hpp"
#include "manoscope/results/simulation.hpp"

namespace manoscope::pipeline {

/// One flow below a wall that stands still, as a Navier-Stokes solver is asked for it.
struct GivenFlow {
  int dim = 2;
  flow::Channel channel;
  flow::Fluid fluid;
  FlowRate flow_rate{};
  Array1 x, zeta;  ///< (n) m, from 0 to the length; width-averaged, smooth
  flow::WallShape wall_shape = flow::WallShape::parabola();  ///< across, in three dimensions
  flow::InletProfile inlet = flow::InletProfile::developed;
  bool leading = true;  ///< the one of this run whose pressure is reported, not its inlet's spread
  /// (n_z) m, from the middle to the side, and (n, n_z) m, smooth: the roof in three dimensions,
  /// in place of zeta and wall_shape. Empty: there is none.
  Array1 z = {};
  Array2 roof = {};
};

/// What the solver answers. Arrays are (n) on its stations from 0 to the length, SI; pressures are
/// 0 in the mean at the end.
struct SolvedFlow {
  Array1 x, gap;
  Array1 mean_pressure, coarse_mean_pressure;  ///< on the mesh, and on the coarser one
  Array1 mean_pressure_uncertainty;            ///< numerical, k = 1
  Array1 wall_pressure, floor_pressure, wall_shear, floor_shear;
  double drop = 0.0, drop_uncertainty = 0.0, coarse_drop = 0.0;  ///< Pa
  bool converged = false;
  double n_unknowns = 0.0, seconds = 0.0, peak_memory = 0.0;  ///< peak_memory in bytes
};

/// @throws InputError for a flow that cannot be solved; Interrupted.
using FlowSolver = std::function<SolvedFlow(const GivenFlow&)>;

/// Which flows are solved for a run.
struct SimulateOptions {
  int dim = 2;
  /// "auto": the experiment's profile, and the other end of what it leaves open; "both": both, and
  /// nothing is known of what lies between; else the one named, as if it were known.
  std::string inlet = "auto";
  /// What the other inlet's numerical uncertainty may add over the test section, of the drop of the
  /// channel; the solver judges the leading flow itself.
  double tolerance = 5e-3;
  RoofChoice roof = RoofChoice::map_if_told;  ///< in three dimensions
};

/// An experiment calibrated and its chosen runs read, ready for a solver.
struct ReadyRuns {
  Calibration calibration;  ///< its runs are the chosen ones
  FlowKnowledge flow;
  std::vector<RunFindings> findings;  ///< of the chosen runs
  std::string inputs;                 ///< inputs_text()
};

/// Calibrates an experiment and reads the named runs.
/// @param names  labels of runs, or "all"; in the order wanted.
/// @throws InputError if there are no flow runs, a name is none of them (told with those there
///         are), a run flows backward, or as calibrate() and know_flow().
ReadyRuns ready_runs(const experiment::Experiment& experiment,
                     const std::vector<std::string>& names, const MeasureOptions& options,
                     int n_threads, const Monitor& monitor);

/// Solves the flow of one run below its measured wall, once or with either profile at the inlet,
/// and holds it against the reading.
///
/// The wall is validation::SmoothShape of the run's profile; in three dimensions it is bent across
/// as roof_of_run() says. The pressure at the channel's end is that of the flow models
/// (outlet_of()). Uncertainty: validation::compare_simulation().
///
/// @param which   index of the run.
/// @throws InputError if the profile cannot be used, and as the solver.
results::Simulation simulate_run(const experiment::Experiment& experiment, const ReadyRuns& ready,
                                 std::size_t which, const SimulateOptions& options,
                                 const FlowSolver& solver, const Monitor& monitor = {});

/// What a person should know of a simulation before believing it, in words.
std::vector<std::string> simulation_doubts(const results::Simulation& simulation,
                                           const experiment::Experiment& experiment);

}  // namespace manoscope::pipeline
