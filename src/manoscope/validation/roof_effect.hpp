#pragma once

#include "manoscope/core/arrays.hpp"
#include "manoscope/core/units.hpp"
#include "manoscope/validation/smooth_roof.hpp"

namespace manoscope::validation {

/// What the wall's shape across does to developed flow, by the resistance of its sections.
struct RoofEffect {
  double departure = 0.0;  ///< of the channel's drop: even roof over the one shape, less 1
  double odd = 0.0;        ///< of the channel's drop: whole roof over its even part, less 1
  Array1 x;                ///< (n) m, from 0 to the length
  /// (n) Pa, standard uncertainty of p(x) by the roof across, 0 at the end: noise of the
  /// departures, taken as if it were of one sign all along, and what the odd part would do.
  Array1 pressure_error;
};

/// Resistance per length of sections under the roof, by their Poisson problem
/// (flow::solve_cross_section()), at some thirty stations, denser at the ends; over the one shape
/// by flow::SectionFamily. An error e(s) of the roof changes the resistance r by
///
///   dr/r = -3 int h^2 f^2 e ds / int h^3 f ds,  f = 1 - exp(-pi (w/2h) (1 - |s|))
///
/// Hadamard's formula, int (du/dn)^2 e dz for int u dA, with the flow between plates times its side
/// layer for u: for an error bar that is enough, and ten times as cheap. (Without the layers an
/// error of mean 0 would do nothing below a flat roof.)
///
/// The odd part counts in second order alone, (e/h)^2: it is solved for where it may exceed 1e-5.
///
/// @throws InputError naming the place where the gap under the roof closes.
RoofEffect roof_effect(const SmoothRoof& roof, const flow::WallShape& shape, Viscosity viscosity,
                       FlowRate flow_rate);

/// Looks at the gap below a roof, height + zeta, on a grid.
/// @param zeta  (n_x, n_z) m at x and z, m.
/// @throws InputError naming the place of the smallest gap if it is not open.
void require_open_gap(const Array1& x, const Array1& z, const Array2& zeta, Length height);

}  // namespace manoscope::validation
