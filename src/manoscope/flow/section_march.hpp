#pragma once

#include <optional>

#include "manoscope/core/arrays.hpp"
#include "manoscope/flow/channel.hpp"
#include "manoscope/flow/marching.hpp"
#include "manoscope/flow/roof.hpp"

namespace manoscope::flow {

/// Options of march_section().
struct SectionMarchOptions {
  InletProfile inlet = InletProfile::developed;
  int nodes_across = 8;  ///< on half the width: even polynomials of degree 2 nodes_across
  int degree_up = 8;     ///< from floor to roof
  int modes = 4;         ///< cosines of the lateral pressure; 0 leaves it out
  int sweeps = 6;        ///< repetitions for the lateral pressure

  /// @throws InputError naming an option out of range.
  void validate() const;
};

/// A flow marched along a channel with its whole section.
struct SectionMarch {
  Array1 pressure;         ///< (n) Pa, mean over the section, 0 at the last station
  Array1 roof_pressure;    ///< (n) Pa, mean over the width: what the wall feels
  Array1 crest_pressure;   ///< (n) Pa, in the middle of the width
  Array1 momentum_factor;  ///< (n) A int u^2 dA / Q^2
  Array1 floor_shear;      ///< (n) Pa, mean over the width
  Array1 roof_shear;       ///< (n) Pa, mean over the width
  Flags1 flags;            ///< (n) bits of MarchFlag
  std::optional<Index> first_separated;
  double last_change = 0.0;  ///< Pa, greatest change of the lateral pressure in the last sweep
};

/// Marches the parabolised equations of a slender channel with its whole section.
///
///   u u_x + v u_y + w u_z = -(P'(x) + p2_x)/rho + nu (u_yy + u_zz),  div = 0,  int u dA = Q
///
/// under the roof h = 2 h0 + zeta(x) g(z). Three velocities need one more equation than continuity
/// gives: the flow turns alike at every height, w/u = m(x, z) (thin gap, w vanishes with u at floor
/// and roof), and continuity then gives m and v. The lateral pressure p2(x, z), which makes room
/// for a bulge that opens over a length like the width, follows from the momentum across averaged
/// over the gap,
///   p2_z = -rho/h [d/dx (h mean(u w)) + d/dz (h mean(w^2))] - eta [w_y]/h,  w = 0 at x = 0,
/// as cosines in z. It acts upstream: the march is repeated, and each time p2 is corrected by
/// (d_zz + c d_xx) dp = d_z (defect), elliptic as inviscid flow has it (c = 1); c = 5 for the slow
/// layers, which answer more to a pressure. p2 = 0 at the outlet and p2_x = 0 at the inlet. Where a
/// sweep meets backflow, p2 is built up once more while the inertia grows in eight steps; backflow
/// that is left is cut off and flagged.
///
/// Source: parabolised Navier-Stokes equations with a global pressure iteration, as in Rubin &
/// Tannehill, Annu. Rev. Fluid Mech. 24 (1992) 117; the closure is our own and held by tests.
/// Polynomials at Chebyshev nodes in s = 2 z/w and t = y/h, variable-step BDF2 along, coefficients
/// extrapolated to the same order. The section's resistance is within 1e-4 at the default degrees.
///
/// Validity: gap << width << length, attached flow, a roof that is the same on both sides. Accuracy
/// on 3-D Navier-Stokes flow in a channel of 1.7 mm by 175 um whose roof bulges by 50 um within
/// 0.6 mm (tests, mean pressure along x in % of the largest): 0.02 at 5 mL/min and 0.2 at 70.
/// Without the lateral pressure (modes = 0): 0.09 and 1.2. 1000 stations take 0.3 to 0.6 s.
///
/// @param x     (n) stations, m, strictly ascending, n >= 3, from the inlet on.
/// @param zeta  (n) width-averaged deflection, m.
/// @throws InputError if a size or value is out of range or a gap is not positive.
SectionMarch march_section(const Channel& channel, const WallShape& shape, const Fluid& fluid,
                           FlowRate flow_rate, const Array1& x, const Array1& zeta,
                           const SectionMarchOptions& options = {});

/// Places across, s = 2 z/w from 0 to 1, where the march wants the gap.
Array1 section_march_nodes(const SectionMarchOptions& options = {});

/// The same where the roof changes its shape along the channel.
/// @param gaps  (n, section_march_nodes()) m, > 0; the mean of both sides.
SectionMarch march_section(const Channel& channel, const Fluid& fluid, FlowRate flow_rate,
                           const Array1& x, const Array2& gaps,
                           const SectionMarchOptions& options = {});

}  // namespace manoscope::flow
