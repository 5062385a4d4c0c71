#include "manoscope/flow/wall_friction.hpp"

#include "manoscope/flow/channel_resistance.hpp"
#include "manoscope/flow/duct_resistance.hpp"

namespace manoscope::flow {

WallShear wall_shear(const SectionsAlong& sections, const Fluid& fluid, FlowRate flow_rate) {
  fluid.validate("wall shear");
  const Array1 gradient = flow_rate.si() * fluid.viscosity.si() / sections.conductance;
  return {gradient * sections.roof_shear, gradient * sections.floor_shear};
}

Pressure plate_shear(Viscosity eta, FlowRate flow_rate, Length width, Length gap) {
  return Pressure::from_si(6.0 * eta.si() * flow_rate.si() / (width.si() * gap.si() * gap.si()));
}

double friction_drag(const SectionsAlong& sections, const Fluid& fluid, FlowRate flow_rate,
                     Length x1, Length x2) {
  fluid.validate("friction drag");
  const Array1 force = flow_rate.si() * fluid.viscosity.si() / sections.conductance * sections.area;
  return (interval_weights(sections.x, x1, x2) * force).sum();
}

double relative_drag(const SectionsAlong& sections, const Channel& channel, const Fluid& fluid,
                     FlowRate flow_rate, Length x1, Length x2) {
  channel.validate("friction drag");
  const double flat =
      flow_rate.si() *
      duct_resistance(fluid.viscosity, channel.width, channel.height, DuctFormula::series) *
      channel.width.si() * channel.height.si() * (x2 - x1).si();
  return friction_drag(sections, fluid, flow_rate, x1, x2) / flat;
}

}  // namespace manoscope::flow
