#include "manoscope/flow/channel_resistance.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "manoscope/core/error.hpp"

namespace manoscope::flow {
namespace {

constexpr const char* kWhere = "channel resistance";

void check_stations(const Array1& x) {
  if (x.size() < 2) {
    throw InputError(kWhere, fmt::format("{} station(s) along the channel", x.size()),
                     "Give at least two");
  }
  for (Index i = 0; i < x.size(); ++i) {
    if (std::isfinite(x(i)) && (i == 0 || x(i) > x(i - 1))) continue;
    throw InputError(
        kWhere,
        fmt::format("station {} at x = {:.6g} mm does not follow the one before it", i, x(i) * 1e3),
        "Sort the stations along the flow and drop duplicates");
  }
}

void check_profile(const Channel& channel, FlowRate flow_rate, const Array1& x,
                   const Array1& zeta) {
  channel.validate(kWhere);
  check_stations(x);
  if (zeta.size() != x.size()) {
    throw InputError(kWhere, fmt::format("{} deflections at {} stations", zeta.size(), x.size()),
                     "Give one deflection a station");
  }
  if (!std::isfinite(flow_rate.si())) {
    throw InputError(kWhere, "the flow rate is not finite", "Give a flow rate such as 70 mL/min");
  }
}

}  // namespace

Array1 interval_weights(const Array1& x, Length x1, Length x2) {
  check_stations(x);
  const Index n = x.size();
  const double first = x(0), last = x(n - 1);
  const double a = x1.si(), b = x2.si();
  if (!(a < b)) {
    throw InputError(kWhere, fmt::format("interval from {:.6g} to {:.6g} mm", a * 1e3, b * 1e3),
                     "Its start must lie before its end");
  }
  // A relative 1e-9 of slack: stations and bounds come from different round-offs.
  const double slack = 1.0 + 1e-9;
  if (first - a > slack * (x(1) - first) || b - last > slack * (last - x(n - 2))) {
    throw InputError(
        kWhere,
        fmt::format("interval {:.6g} to {:.6g} mm, but stations only from {:.6g} to {:.6g} mm",
                    a * 1e3, b * 1e3, first * 1e3, last * 1e3),
        "Choose an interval inside the measured part of the channel");
  }
  Array1 weights = Array1::Zero(n);
  weights(0) += std::max(0.0, std::min(first, b) - a);
  weights(n - 1) += std::max(0.0, b - std::max(last, a));
  for (Index i = 0; i + 1 < n; ++i) {
    const double from = std::max(a, x(i)) - x(i), to = std::min(b, x(i + 1)) - x(i);
    if (!(from < to)) continue;
    const double right = 0.5 * (to * to - from * from) / (x(i + 1) - x(i));
    weights(i + 1) += right;
    weights(i) += (to - from) - right;
  }
  return weights;
}

ResistanceDrop resistance_drop(const Channel& channel, Viscosity eta, FlowRate flow_rate,
                               const Array1& x, const Array1& zeta, Length x1, Length x2,
                               DuctFormula formula) {
  check_profile(channel, flow_rate, x, zeta);
  const Array1 weights = flow_rate.si() * interval_weights(x, x1, x2);
  const Array1 gap = channel.height.si() + zeta;
  ResistanceDrop result;
  result.drop =
      Pressure::from_si((weights * duct_resistance(eta, channel.width, gap, formula)).sum());
  result.zeta_gradient = weights * duct_resistance_slope(eta, channel.width, gap, formula);
  result.height_gradient = result.zeta_gradient.sum();
  return result;
}

Array1 running_resistance_drop(const Channel& channel, Viscosity eta, FlowRate flow_rate,
                               const Array1& x, const Array1& zeta, DuctFormula formula) {
  check_profile(channel, flow_rate, x, zeta);
  const Array1 r = duct_resistance(eta, channel.width, channel.height.si() + zeta, formula);
  Array1 drop(x.size());
  drop(0) = 0.0;
  for (Index i = 1; i < x.size(); ++i) {
    drop(i) = drop(i - 1) + flow_rate.si() * 0.5 * (r(i) + r(i - 1)) * (x(i) - x(i - 1));
  }
  return drop;
}

Array1 local_reynolds(const Channel& channel, const Fluid& fluid, FlowRate flow_rate,
                      const Array1& zeta) {
  channel.validate(kWhere);
  fluid.validate(kWhere);
  const double nu = fluid.kinematic_viscosity().si();
  const Array1 perimeter_half = channel.width.si() + channel.height.si() + zeta;
  return 2.0 * std::abs(flow_rate.si()) / (nu * perimeter_half);
}

double channel_reynolds(const Channel& channel, const Fluid& fluid, FlowRate flow_rate,
                        const Array1& x, const Array1& zeta) {
  check_profile(channel, flow_rate, x, zeta);
  const Array1 weights = interval_weights(x, Length{}, channel.length);
  return (weights * local_reynolds(channel, fluid, flow_rate, zeta)).sum() / channel.length.si();
}

}  // namespace manoscope::flow
