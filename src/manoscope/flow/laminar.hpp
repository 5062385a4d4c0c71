#pragma once

#include "manoscope/flow/channel.hpp"

namespace manoscope::flow {

/// Reynolds number on the hydraulic diameter up to which disturbances of the flow in a duct die.
/// Source: e.g. F. M. White, Viscous Fluid Flow (2006), ch. 5.
inline constexpr double kLargestLaminarReynolds = 2000.0;

/// Re = 2 Q/(nu (w + h)), on the hydraulic diameter of the undeflected channel.
inline double duct_reynolds(const Channel& channel, const Fluid& fluid, FlowRate flow_rate) {
  return 2.0 * flow_rate.si() * fluid.density.si() /
         (fluid.viscosity.si() * (channel.width.si() + channel.height.si()));
}

}  // namespace manoscope::flow
