#include "manoscope/flow/aperture_loss.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "manoscope/core/error.hpp"

namespace manoscope::flow {

Pressure aperture_loss(Viscosity eta, FlowRate flow_rate, Length width, Length height) {
  const double w = std::max(width.si(), height.si()), h = std::min(width.si(), height.si());
  if (!(h > 0.0 && eta.si() > 0.0)) {
    throw InputError("aperture loss",
                     fmt::format("a hole of {:g} by {:g} mm, viscosity {:g} mPa s", width.in(mm),
                                 height.in(mm), eta.in(mPa_s)),
                     "Give positive sides and a positive viscosity");
  }
  const double ratio = h / w;
  const double integral = std::comp_ellint_2(std::sqrt(1.0 - ratio * ratio));
  return Pressure::from_si(3.0 / std::numbers::inv_sqrtpi * eta.si() * flow_rate.si() * integral /
                           (w * h * h));
}

}  // namespace manoscope::flow
