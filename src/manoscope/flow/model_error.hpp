#pragma once

#include "manoscope/core/arrays.hpp"
#include "manoscope/core/units.hpp"
#include "manoscope/flow/flow_models.hpp"

namespace manoscope::flow {

/// Reduced Reynolds number Re h/l = (Q/(w nu)) (h/l): how far a flow is from creeping.
///
/// h is the mean gap over the channel's stations, 2 h0 + mean zeta.
/// @param zeta  (n) m.
/// @return dimensionless, never negative.
double reduced_reynolds(const Channel& channel, const Fluid& fluid, FlowRate flow_rate,
                        const Array1& zeta);

/// How much of a drop the fluid's change of speed moves, greatest along x, as a share of the drop
/// by friction: max |1.2 rho Q^2/2 (1/A(x)^2 - 1/A(l)^2)| / dp by eq. (4), A = w (2 h0 + zeta). 0
/// in a flat channel, whatever the flow rate.
///
/// @param flow  two stations or more; zeta in (-2 h0, inf).
double inertia_share(const FlowCase& flow);

/// How wrong a flow model may be.
struct ModelError {
  double reduced_reynolds = 0.0;  ///< Re h/l
  double half_width = 0.0;        ///< greatest error of p, as a share of its drop along the channel
  /// The same error as a standard uncertainty: half_width / sqrt(3), a rectangular distribution
  /// (JCGM 100:2008, 4.3.7).
  double standard() const;
};

/// Error of a model's pressure, relative to the drop along the channel.
///
///   half width = c inertia_share()
///
/// with c no smaller than what was found on 3-D Navier-Stokes flow of a bulged channel at 5 and
/// 70 mL/min, and against the march on sections in the channels S1 to S5 at all their flow rates
/// (docs/flow-models.md): 1.5 for creeping flow, 0.6 for momentum, 0.85 for energy, 0.15 for the
/// march in the plane, three times that where the roof rises by a third of the gap, 0.015 for the
/// march on sections; never below 1e-4. Added to it:
///   paper       0.25 mean|zeta|/(2 h0): a rectangle of the mean gap resists too much (parabolic
///               roof, the table of sections there)
///   developing  2.4 %, what its correlation claims for itself
///
/// Validity: found in these channels, assumed elsewhere; the march on sections was held against
/// Navier-Stokes flow in one of them. It holds what the equations leave out, not what they are fed:
/// gap, fluid, flow rate, and the profile at the inlet.
ModelError model_error(FlowModel model, const FlowCase& flow);

}  // namespace manoscope::flow
