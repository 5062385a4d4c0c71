#pragma once

#include "manoscope/core/units.hpp"
#include "manoscope/flow/roof.hpp"

namespace manoscope::flow {

/// Developed laminar flow through one section: what the section does to the flow, free of the
/// fluid.
///
/// u is the axial velocity, U = Q/A its mean, G = -dp/dx.
struct CrossSection {
  double area = 0.0;             ///< A, m2
  double perimeter = 0.0;        ///< wetted, m
  double mean_gap = 0.0;         ///< A/w, m
  double conductance = 0.0;      ///< Q eta / G, m4
  double momentum_factor = 0.0;  ///< beta = mean of (u/U)^2
  double energy_factor = 0.0;    ///< alpha = mean of (u/U)^3
  double floor_shear = 0.0;      ///< mean wall shear stress / G on the floor, m
  double roof_shear = 0.0;       ///< the same on the roof, over its arc length, m
  double side_shear = 0.0;       ///< the same on the two sides together, m
  double roof_length = 0.0;      ///< arc length of the roof, m
  double side_height = 0.0;      ///< of the two sides together, m

  /// Resistance per unit length r = G/Q, Pa s / m^4.
  double resistance(Viscosity eta) const { return eta.si() / conductance; }
  /// F of r = 12 eta / (w h^3 F) with the mean gap h; a rectangle's F is duct_flow_factor().
  double flow_factor() const { return 12.0 * conductance / (area * mean_gap * mean_gap); }
  double hydraulic_diameter() const { return 4.0 * area / perimeter; }  ///< m
  /// Fanning friction factor times Reynolds number on the hydraulic diameter, 24 between plates.
  double friction_reynolds() const {
    const double diameter = hydraulic_diameter();
    return 0.5 * area * diameter * diameter / conductance;
  }
};

/// Polynomial degrees of solve_cross_section().
struct CrossSectionOptions {
  int degree_across = 0;  ///< along z; 0 takes degree_for_gap() of the least gap
  int degree_up = 20;     ///< from floor to roof

  /// @throws InputError naming a degree out of range.
  void validate() const;
};

/// Degree across that resolves the side layers of a gap, 32 for a square to 80 for h/w <= 0.02.
int degree_for_gap(double width_over_gap);

/// Solves the Poisson problem of developed flow under a curved roof.
///
///   laplace u = -1 in 0 < y < h(z), |z| < w/2;  u = 0 on floor, roof and sides
///
/// from which Q eta/G = int u dA, beta = A int u^2 / (int u)^2, alpha = A^2 int u^3 / (int u)^3.
/// Source: the section problem of unidirectional flow, e.g. H. Bruus, Theoretical Microfluidics
/// (2008), ch. 3. Galerkin's method with integrated Legendre polynomials in the mapped coordinates
/// s = 2 z/w, t = y/h(z); resistance converges with the square of the error of u.
///
/// Accuracy (held by tests): resistance of rectangles of 0.05 <= h/w <= 1 within 5e-9 of the series
/// (1e-9 up to 0.2), beta and alpha within 1e-8; a curved roof with an exact solution within 2e-8;
/// shears of floor and roof within 2e-5 (5e-5 at h/w = 1), of the sides 3e-4; thinner gaps, h/w =
/// 0.01, within 1e-6. A half circle, whose roof meets the floor, is within 2e-7. Validity:
/// developed flow, roof single-valued in z with a smooth h. One symmetric section takes about 5 ms;
/// one that is not symmetric has twice the unknowns.
///
/// @throws InputError if the width or a gap at a quadrature point is not positive and finite.
CrossSection solve_cross_section(const Roof& roof, const CrossSectionOptions& options = {});

}  // namespace manoscope::flow
