#pragma once

#include <optional>

#include "manoscope/core/arrays.hpp"
#include "manoscope/flow/channel.hpp"
#include "manoscope/flow/marching.hpp"

namespace manoscope::flow {

/// Options of march_plane().
struct PlaneMarchOptions {
  InletProfile inlet = InletProfile::developed;
  int degree = 20;  ///< of the velocity profile from floor to roof

  /// @throws InputError if the degree is out of range.
  void validate() const;
};

/// A flow marched along a gap.
struct PlaneMarch {
  Array1 pressure;         ///< (n) Pa, the mean over the gap, 0 at the last station
  Array1 roof_pressure;    ///< (n) Pa, on the roof: with the pressure across the stream
  Array1 floor_pressure;   ///< (n) Pa, on the floor
  Array1 wall_shear;       ///< (n) Pa, on floor and roof alike
  Array1 momentum_factor;  ///< (n) h int u^2 dy / q^2; 6/5 of a parabola
  Array1 profile_nodes;    ///< (m) y/h
  Array2 velocity;         ///< (n, m) m/s
  Flags1 flags;            ///< (n) bits of MarchFlag
  std::optional<Index> first_separated;
};

/// Marches the boundary-layer (slender-channel, parabolised) equations along a plane gap.
///
///   u u_x + v u_y = -p'(x)/rho + nu/F u_yy,  u_x + v_y = 0,
///   u = 0 on floor and roof, int_0^h u dy = q
///
/// In x and t = y/h(x) with the stream function psi = h int_0^t u dt:
///   u u_x - psi_x u_t / h = -p'/rho + nu/(F h^2) u_tt
/// so that only the gap itself is used, not its slope. Source: H. Schlichting & K. Gersten,
/// Boundary-Layer Theory (2000), ch. 6 and 14 (slender channels); side walls by viscosity / F, F of
/// duct_flow_factor() or CrossSection::flow_factor(), which is exact for developed flow.
/// Polynomials at Chebyshev nodes across, variable-step BDF2 along, Newton at every station.
///
/// The pressure across the stream is the next order in slenderness and is added afterwards:
///   p_y = -rho (u v_x + v v_y) + eta v_yy,
/// its mean over the gap left as it is.
///
/// Validity: h' << 1 and an attached flow; nothing of the outlet is felt upstream. Accuracy on 2-D
/// Navier-Stokes flow in a gap of 175 um that bulges by 33 um within 0.6 mm, from 0.39 mm on
/// (tests): 0.015 % of the pressure drop at 5 mL/min, 0.3 % at 70 mL/min where v = 0 is forced on
/// the inlet, 0.1 % where the flow comes from a straight lead-in. Second order in the spacing of
/// the stations; 1000 stations take about 0.1 s.
///
/// @param x            (n) stations, m, strictly ascending, n >= 3.
/// @param gap          (n) h, m, > 0.
/// @param side_factor  (n) F, > 0; 1 without side walls.
/// @param flow_per_width  q, m2/s, > 0.
/// @throws InputError if a size or a value is out of range.
PlaneMarch march_plane(const Array1& x, const Array1& gap, const Array1& side_factor,
                       double flow_per_width, const Fluid& fluid,
                       const PlaneMarchOptions& options = {});

}  // namespace manoscope::flow
