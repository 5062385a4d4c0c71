#pragma once

#include "flow_simulation.hpp"
#include "flow_solver.hpp"
#include "manoscope/core/monitor.hpp"
#include "passage_geometry.hpp"
#include "simulation_options.hpp"

namespace manoscope::navier_stokes {

/// What a passage costs: mean pressures before less behind, Pa.
struct PassageFlow {
  int dim = 3;
  double drop = 0.0;              ///< from the far end to the channel's end, seen along the flow
  double drop_uncertainty = 0.0;  ///< numerical, k = 1
  double coarse_drop = 0.0;       ///< on the coarser mesh
  /// drop_uncertainty is within the tolerance asked for, with an edge of friction and rho U^2/2
  /// where these are more than the drop.
  bool converged = false;
  FlowCosts costs;  ///< of both meshes; unknowns of the finer
};

/// The flow in a passage as a problem free of units: lengths in heights of the channel, velocities
/// in the mean one of its section. x = 0 is the end of the channel, the passage lies at x < 0
/// (inlet) or x > 0 (outlet).
/// @param coarse  on the second, coarser mesh.
/// @throws InputError for sizes out of range.
template <int dim>
FlowProblem<dim> passage_problem(const SimulatedPassage& given, const MeshOptions& mesh,
                                 bool coarse);

/// Drop of a rigid passage by the Navier-Stokes equations, the parasitic drop of the paper's
/// appendix A.
///
/// Solved are the passage, a straight piece of the channel (of its height at the rim, three gaps
/// and a width long) and what lies beyond the passage. Developed flow enters where the mesh
/// begins, in the far section or in the channel; du/dn = p n where it ends. The drop runs from the
/// far end of the passage to the section of the channel at its end (inlet; outlet: the other way).
/// Beyond a step or in a port the mean pressure is that where the mesh ends, less the drop of
/// developed flow between there and the passage. Solved of it are four heights of a wider section,
/// behind an outlet 0.1 Re more, and three lengths of a port: twice as much before an inlet moves
/// the drop by less than the uncertainty at Re = 690 in the plane (test for a port). In three
/// dimensions no more than 20 heights are solved; what a jet may give back of its pressure behind
/// them is counted as uncertain.
///
/// Numerical uncertainty: twice the difference of two meshes (the coarser has at most two thirds of
/// the cells of any stretch), where there is a step or a port at least 0.2 % of the drop, or of
/// friction and rho U^2/2 where these are more: cells shrink towards an edge, 1/400 of the gap in
/// the plane, 1/40 in three dimensions, and what is left of the error there need not show in the
/// difference. In the plane cubic velocities moved drops by 0.1 to 0.25 %, in three dimensions that
/// of a creeping step 1:2, whose u was 0.9 %, by 0.5 %.
/// Validity: laminar, steady; on a wall where a step begins the pressure is not finite, its mean
/// over a section is.
///
/// @param files  what to write meanwhile; in the flow for ParaView p = 0 at the channel's end.
/// @throws InputError for sizes out of range, or if no steady flow is found.
PassageFlow simulate_passage(const SimulatedPassage& given, const MeshOptions& mesh,
                             const SimulationFiles& files = {}, const Monitor& monitor = {});

}  // namespace manoscope::navier_stokes
