#pragma once

#include "manoscope/core/arrays.hpp"
#include "manoscope/core/units.hpp"
#include "manoscope/flow/channel.hpp"
#include "manoscope/flow/section_family.hpp"

namespace manoscope::flow {

/// Wall shear stress along a channel, mean over the width.
struct WallShear {
  Array1 roof, floor;  ///< (n) Pa
};

/// Wall shear of developed flow, G times the section's shear per pressure gradient, G = r Q.
///
/// Source: the force balance of solve_cross_section(). Validity: creeping flow; within 2e-5 for the
/// section itself. Where the march is used, it has its own (SectionMarch::roof_shear).
WallShear wall_shear(const SectionsAlong& sections, const Fluid& fluid, FlowRate flow_rate);

/// Wall shear between two wide plates: tau = 3 eta q/(2 h0^2), q = Q/w, gap 2 h0; that is
/// 6 eta q/h^2 for a gap h.
///
/// Source: Ozsun, Yakhot & Ekinci (2013), the remark on drag; printed there with eta squared, a
/// slip: its own steps give this. Validity: no side walls, so high by their share of the force.
Pressure plate_shear(Viscosity eta, FlowRate flow_rate, Length width, Length gap);

/// Friction drag on all walls of a stretch, N: int G A dx = int r Q A dx.
///
/// Source: the balance of forces on the fluid of developed flow; the same trapezoid rule as
/// friction_drop(). Second order in the spacing of the stations.
/// @param x1, x2  within the stations' reach (interval_weights()).
double friction_drag(const SectionsAlong& sections, const Fluid& fluid, FlowRate flow_rate,
                     Length x1, Length x2);

/// Drag of a stretch over that of the undeflected channel at the same flow rate, 1 if nothing
/// bends.
///
/// The undeflected channel is the rectangle of the exact series. Below 1 where the wall bulges:
/// drag goes as h^-2.
double relative_drag(const SectionsAlong& sections, const Channel& channel, const Fluid& fluid,
                     FlowRate flow_rate, Length x1, Length x2);

}  // namespace manoscope::flow
