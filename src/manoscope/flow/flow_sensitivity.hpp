#pragma once

#include "manoscope/core/arrays.hpp"
#include "manoscope/core/units.hpp"
#include "manoscope/flow/flow_models.hpp"
#include "manoscope/flow/section_family.hpp"

namespace manoscope::flow {

/// Tables of the sections of a channel and of the same channel a little higher, solved once for
/// many flows and deflections.
struct SectionTables {
  SectionFamily family, higher;
  Length step{};  ///< the second channel's height less the first's
  /// @throws InputError as SectionFamily.
  static SectionTables of(const Channel& channel, const WallShape& shape, Length least,
                          Length greatest);
};

/// What moves the pressure of a flow model, all else held, the pressure at the outlet held.
struct FlowSensitivity {
  ModelledPressure modelled;
  Matrix by_zeta;       ///< (n, n) dp_i/d zeta_j, Pa/m
  Array1 by_height;     ///< (n) dp/d(2 h0), Pa/m
  Array1 by_flow_rate;  ///< (n) Q dp/dQ, Pa: per relative change
  Array1 by_viscosity;  ///< (n) eta dp/d eta, Pa: per relative change
};

/// Pressure along the channel with its derivatives.
///
/// Central differences of pressure_along() in every zeta_j, on tabulated sections; a forward
/// difference in the height, a central one in the flow rate. With the density held, p - p_out is
/// eta Q times a function of Q/eta, so that
///
///   eta dp/d eta = 2 (p - p_out) - Q dp/dQ
///
/// Accuracy: by_zeta within 1e-3 of the greatest derivative for models that do not march, by_height
/// 0.5 %. The marches take by_zeta from `momentum`, which is right in friction and up to a tenth or
/// two off where inertia is as large as friction: enough for an error bar, and three orders of
/// magnitude faster; section-march takes the other derivatives from plane-march, within 2 % (test).
/// Validity: that of the model.
///
/// @throws InputError as pressure_along(), or if a deflection leaves the tables.
FlowSensitivity flow_sensitivity(FlowModel model, const FlowCase& flow,
                                 const SectionTables& tables);
/// The same with tables of its own, for one flow.
FlowSensitivity flow_sensitivity(FlowModel model, const FlowCase& flow);

/// Pressure alone, on the tables.
ModelledPressure pressure_along(FlowModel model, const FlowCase& flow, const SectionTables& tables);

}  // namespace manoscope::flow
