#pragma once

#include <string>

#include "manoscope/core/units.hpp"

namespace manoscope::navier_stokes {

/// Cells and elements of a simulation.
struct MeshOptions {
  int dim = 2;
  int order = 2;         ///< of the velocities
  int cells_along = 0;   ///< between x = 0 and the end of the channel; 0: by its length
  int cells_up = 0;      ///< from floor to roof; 0: 8 in two dimensions, 4 in three
  int cells_across = 0;  ///< of half the width; 0: 8
  double tolerance = 5e-3;

  /// @throws InputError naming the first option out of range.
  void validate() const;
};

/// Options of `manoscope simulate` and of the program it starts.
struct SimulationOptions {
  Length height{};
  Length width{};
  FlowRate flow_rate{};
  Viscosity viscosity = 1.0 * mPa_s;
  Density density = 998.0 * kg_per_m3;
  std::string inlet = "developed";
  Length lead_in{};
  Length lead_out{};
  bool lead_in_slips = false;
  int stations = 101;
  MeshOptions mesh;

  /// The only list of names and help texts: command line and manual read it.
  template <class Visitor>
  void describe(Visitor&& visit) {
    visit("height", height, "gap of the undeflected channel, e.g. 175um");
    visit("width", width, "width of the channel, e.g. 1.7mm");
    visit("flow-rate", flow_rate, "volumetric flow rate, e.g. 70mL/min");
    visit("viscosity", viscosity, "dynamic viscosity of the fluid");
    visit("density", density, "density of the fluid");
    visit("dim", mesh.dim, "2: between plates, 3: the whole channel, its roof a parabola across");
    visit("inlet", inlet, "profile where the flow enters: developed or uniform");
    visit("lead-in", lead_in, "length of a rigid straight duct before the channel");
    visit("lead-out", lead_out, "length of a rigid straight duct behind the channel");
    visit("lead-in-slips", lead_in_slips,
          "the lead-in has no friction: a uniform flow meets the channel");
    visit("order", mesh.order, "degree of the velocities in a cell, 2 to 4");
    visit("cells-along", mesh.cells_along, "cells along the channel; 0 chooses");
    visit("cells-up", mesh.cells_up, "cells from floor to roof; 0 chooses");
    visit("cells-across", mesh.cells_across, "cells over half the width; 0 chooses");
    visit("tolerance", mesh.tolerance,
          "numerical uncertainty of the drop, of the drop, up to which it counts as converged");
    visit("stations", stations, "number of stations of the result, evenly along the channel");
  }
  /// @throws InputError naming the first option that is missing or out of range.
  void validate() const;
};

}  // namespace manoscope::navier_stokes
