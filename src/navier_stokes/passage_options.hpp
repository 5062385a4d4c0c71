#pragma once

#include <string>

#include "manoscope/core/units.hpp"
#include "passage_geometry.hpp"
#include "simulation_options.hpp"

namespace manoscope::navier_stokes {

/// Options of the solver program for one passage (`--passage inlet` or `--passage outlet`).
struct PassageOptions {
  std::string passage = "inlet";
  SimulatedPassage given;
  std::string port_side = "top";
  MeshOptions mesh{3};

  /// The only list of names and help texts.
  template <class Visitor>
  void describe(Visitor&& visit) {
    visit("passage", passage, "inlet: it leads to the channel; outlet: away from it");
    visit("length", given.passage.length, "length of the passage");
    visit("width", given.passage.width, "its width");
    visit("height", given.passage.height, "its height");
    visit("channel-width", given.channel.width, "width of the channel");
    visit("channel-height", given.channel.height, "gap of the channel at its end");
    visit("beyond-width", given.beyond_width,
          "width of what lies beyond the passage behind a step; 0m: nothing");
    visit("beyond-height", given.beyond_height, "its height");
    visit("port", given.port, "length along the flow of a port at the far end; 0m: none");
    visit("port-side", port_side, "top: in the roof; side: in one side wall");
    visit("flow-rate", given.flow_rate, "volumetric flow rate, e.g. 70mL/min");
    visit("viscosity", given.fluid.viscosity, "dynamic viscosity of the fluid");
    visit("density", given.fluid.density, "density of the fluid");
    visit("dim", mesh.dim, "2: between plates, 3: the whole passage");
    visit("order", mesh.order, "degree of the velocities in a cell, 2 to 4");
    visit("tolerance", mesh.tolerance,
          "numerical uncertainty of the drop, of the drop, up to which it counts as converged");
    visit("solver", mesh.solver,
          "linear systems: direct, iterative, or auto by the number of cells");
  }
};

/// The passage that the options tell.
/// @throws InputError naming the first option out of range.
SimulatedPassage passage_of(const PassageOptions& options);

}  // namespace manoscope::navier_stokes
