#include "manoscope/flow/one_dimensional.hpp"

#include <fmt/format.h>

#include "manoscope/core/error.hpp"
#include "manoscope/flow/channel_resistance.hpp"

namespace manoscope::flow {

Array1 one_dimensional_pressure(const Channel& channel, const Fluid& fluid, FlowRate flow_rate,
                                const Array1& x, const Array1& zeta, Pressure outlet_pressure,
                                const OneDimensionalOptions& options) {
  const DuctFormula formula = options.formula();
  const Array1 running =
      running_resistance_drop(channel, fluid.viscosity, flow_rate, x, zeta, formula);
  const Index last = x.size() - 1;
  const double to_outlet = channel.length.si() - x(last);
  const double spacing = x(last) - x(last - 1);
  if (to_outlet < -1e-9 * spacing || to_outlet > spacing * (1.0 + 1e-9)) {
    throw InputError("one-dimensional flow",
                     fmt::format("the last station is at x = {:.6g} mm in a channel {:.6g} mm long",
                                 x(last) * 1e3, channel.length.in(mm)),
                     "Give stations up to the outlet, at most one spacing from it");
  }
  // The last bit to the outlet at the last station's resistance, as interval_weights() does.
  const double last_gap = channel.height.si() + zeta(last);
  const double rest =
      flow_rate.si() * to_outlet *
      duct_resistance(fluid.viscosity, channel.width, Length::from_si(last_gap), formula);
  return outlet_pressure.si() + rest + (running(last) - running);
}

Pressure acceleration_drop(const Channel& channel, const Fluid& fluid, FlowRate flow_rate,
                           Length zeta_start, Length zeta_end, double momentum_factor) {
  const auto speed = [&](Length zeta) {
    const Length gap = channel.height + zeta;
    if (!(gap > Length{})) {
      throw InputError("acceleration drop", fmt::format("the gap is {:g} um", gap.in(um)),
                       "Give deflections of a channel that is open");
    }
    return flow_rate.si() / (channel.width.si() * gap.si());
  };
  const double start = speed(zeta_start), end = speed(zeta_end);
  return Pressure::from_si(0.5 * momentum_factor * fluid.density.si() *
                           (end * end - start * start));
}

}  // namespace manoscope::flow
