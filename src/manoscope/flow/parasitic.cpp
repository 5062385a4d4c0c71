#include "manoscope/flow/parasitic.hpp"

#include <fmt/format.h>

#include <cmath>

#include "manoscope/core/error.hpp"
#include "manoscope/flow/duct_resistance.hpp"

namespace manoscope::flow {

Pressure passage_drop(Viscosity eta, FlowRate flow_rate, const RigidPassage& passage) {
  if (!(passage.length.si() > 0.0) || !std::isfinite(passage.length.si())) {
    throw InputError("rigid passage", fmt::format("its length is {:g} mm", passage.length.in(mm)),
                     "Give a positive length such as \"5 mm\", or leave the passage out");
  }
  const double r = duct_resistance(eta, passage.width, passage.height, DuctFormula::series);
  return Pressure::from_si(flow_rate.si() * r * passage.length.si());
}

}  // namespace manoscope::flow
