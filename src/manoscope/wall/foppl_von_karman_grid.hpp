#pragma once

// How foppl_von_karman.cpp and its neighbours see a wall: one grid with its scales.

#include "manoscope/wall/foppl_von_karman.hpp"
#include "manoscope/wall/fvk_newton.hpp"

namespace manoscope::wall {

struct WallState::Grid {
  Grid(const ClampedWall& wall, const FopplVonKarmanOptions& options, Index n_cells_x,
       Index n_cells_z);

  double half_width, thickness;  ///< a, t: units of length and deflection, m
  double pressure;               ///< unit of pressure E t^4/((1 - nu^2) a^4), Pa
  double energy;                 ///< unit of energy, J
  double halves;                 ///< 2 if the model is one half of the wall, else 1
  FvkModel model;
  ResidualNorm norm;
};

}  // namespace manoscope::wall
