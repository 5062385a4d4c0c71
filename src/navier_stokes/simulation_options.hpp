#pragma once

#include <string>

#include "manoscope/core/units.hpp"
#include "manoscope/flow/roof.hpp"

namespace manoscope::navier_stokes {

/// Cells and elements of a simulation.
struct MeshOptions {
  int dim = 2;
  int order = 2;         ///< of the velocities
  int cells_along = 0;   ///< between x = 0 and the end of the channel; 0: by its length
  int cells_up = 0;      ///< from floor to roof; 0: 8 in two dimensions, 5 in three
  int cells_across = 0;  ///< of half the width; 0: 8
  double tolerance = 5e-3;
  std::string solver = "auto";  ///< direct, iterative, or by the number of unknowns

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
  std::string inlet = "auto";
  std::string wall_shape = "auto";
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
    visit("dim", mesh.dim, "2: between plates, 3: the whole channel");
    visit("inlet", inlet,
          "profile where the flow enters: developed, uniform, or both, one after the other; auto: "
          "what an experiment leaves open, else developed");
    visit("wall-shape", wall_shape,
          "roof across in three dimensions: map, as the maps of the run or the table show it; "
          "response, of an experiment one shape, that between lowest and highest level; of a table "
          "without a map parabola, or the coefficients of 1, s^2, s^4.., s = 2 z/width, as 1,-2,1; "
          "auto: map where there is one, else response or parabola");
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
    visit("solver", mesh.solver,
          "linear systems: direct, iterative, or auto by the number of cells");
    visit("stations", stations, "number of stations of the result, evenly along the channel");
  }
  /// @throws InputError naming the first option that is missing or out of range.
  void validate() const;
  /// The same but for sizes, flow rate and fluid, which an experiment tells.
  void validate_solution() const;
};

/// Whether `wall_shape` names no shape of its own but "auto", "map" or "response".
bool leaves_wall_shape(const SimulationOptions& options);
/// The shape that `wall_shape` tells; a parabola where it leaves that open.
/// @throws InputError for text that is none.
flow::WallShape wall_shape_of(const SimulationOptions& options);
/// The text that wall_shape_of() reads back, every digit.
std::string wall_shape_text(const flow::WallShape& shape);

}  // namespace manoscope::navier_stokes
