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
///   half width = e_1 (Re h/l / R_1)^k through (R_1, e_1) and (R_2, e_2),
///
/// the greatest errors found on 3-D Navier-Stokes flow of a bulged channel at Re h/l = 0.6 and 8
/// (kFlowModels, docs/flow-models.md), as a power of Re h/l in between and beyond; never below
/// 1e-4. Added to it:
///   paper       0.25 mean|zeta|/(2 h0): a rectangle of the mean gap resists too much (parabolic
///               roof, the table of sections there)
///   developing  2.4 %, what its correlation claims for itself
///
/// Validity: known at the two points, assumed elsewhere; beyond Re h/l = 8 an extrapolation. It
/// holds what the equations leave out, not what they are fed: gap, fluid, flow rate, and the
/// profile at the inlet.
ModelError model_error(FlowModel model, const FlowCase& flow);

}  // namespace manoscope::flow
