#pragma once

#include <functional>

#include "manoscope/core/arrays.hpp"
#include "manoscope/flow/channel.hpp"
#include "manoscope/flow/section_family.hpp"

// Terms of the one-dimensional balance on true sections, each its own line. All are running drops:
// (n) Pa, 0 at the first station, positive where the pressure falls along +x.

namespace manoscope::flow {

/// Friction of developed flow: Q int r dx, r = eta/conductance. Trapezoid rule, second order.
Array1 friction_drop(const SectionsAlong& sections, const Fluid& fluid, FlowRate flow_rate);

/// What the gain of momentum takes: int (1/A) d(beta rho Q^2/A).
///
///   = rho Q^2 [beta/(2 A^2)] + rho Q^2 int dbeta/(2 A^2)
///
/// Source: the x-momentum of unidirectional profiles integrated over the section, T. J. Pedley, The
/// Fluid Mechanics of Large Blood Vessels (1980), ch. 6. Validity: profiles as in developed flow;
/// at Re h/l of order 1 that is off by several per cent of the pressure.
Array1 momentum_drop(const SectionsAlong& sections, const Fluid& fluid, FlowRate flow_rate);

/// What the gain of kinetic energy takes: rho Q^2 [alpha/(2 A^2)], instead of momentum_drop().
///
/// Source: the mechanical energy integrated over the section with the dissipation of developed
/// flow.
Array1 energy_drop(const SectionsAlong& sections, const Fluid& fluid, FlowRate flow_rate);

/// Speed index S^2 = (beta - A dbeta/dA) rho Q^2 (dA/dp)/A^3 of a wall that gives way at once.
///
/// With S^2 < 1 a change of pressure travels upstream, at S^2 = 1 the flow chokes.
/// Source: A. H. Shapiro, J. Biomech. Eng. 99 (1977) 126 (S is the speed over that of the pulse).
/// @param area_by_pressure  dA/dp, m2/Pa, >= 0.
double speed_index(double momentum_factor, double momentum_factor_slope, const Fluid& fluid,
                   FlowRate flow_rate, double area, double area_by_pressure);

/// What a wall answers to a pressure at a place, as a local law zeta(x, p).
struct WallAnswer {
  double zeta = 0.0;         ///< width-averaged deflection, m
  double by_pressure = 0.0;  ///< d zeta/dp, m/Pa
  double by_place = 0.0;     ///< d zeta/dx at the same pressure, 1
};

/// Pressure along a channel whose wall gives way, from the outlet upstream.
///
///   dp/dx = -[r Q + (rho Q^2/A) d(beta/A)/dA A_x] / (1 - S^2),  A = w (2 h0 + zeta(x, p))
///
/// Source: momentum integral with A(p, x); S of speed_index(). Runge-Kutta 4 between the stations.
/// Validity: that of momentum_drop(), and a wall that answers to the pressure at its own place.
///
/// @param wall  the wall's law; asked between the stations too.
/// @param x     (n) m, strictly ascending; the outlet pressure is at the last.
/// @return (n) Pa.
/// @throws InputError where the flow chokes (S^2 >= 1), saying where and at which flow rate it
/// would
///         not, and where the deflection leaves the range of the family.
Array1 compliant_pressure(const SectionFamily& family, const Channel& channel, const Fluid& fluid,
                          FlowRate flow_rate, const Array1& x, Pressure outlet_pressure,
                          const std::function<WallAnswer(double x, double p)>& wall);

}  // namespace manoscope::flow
