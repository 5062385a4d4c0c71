#include "manoscope/flow/section_flow.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "manoscope/core/error.hpp"

namespace manoscope::flow {
namespace {

void check(const Fluid& fluid, FlowRate flow_rate) {
  fluid.validate("flow through the sections");
  if (std::isfinite(flow_rate.si())) return;
  throw InputError("flow through the sections", "the flow rate is not finite",
                   "Give a flow rate such as 70 mL/min");
}

}  // namespace

Array1 friction_drop(const SectionsAlong& sections, const Fluid& fluid, FlowRate flow_rate) {
  check(fluid, flow_rate);
  Array1 drop(sections.x.size());
  drop(0) = 0.0;
  const Array1 r = fluid.viscosity.si() / sections.conductance;
  for (Index i = 1; i < drop.size(); ++i) {
    const double step = sections.x(i) - sections.x(i - 1);
    drop(i) = drop(i - 1) + flow_rate.si() * 0.5 * (r(i) + r(i - 1)) * step;
  }
  return drop;
}

Array1 momentum_drop(const SectionsAlong& sections, const Fluid& fluid, FlowRate flow_rate) {
  check(fluid, flow_rate);
  const double scale = 0.5 * fluid.density.si() * flow_rate.si() * flow_rate.si();
  const Array1 thin = sections.area.square().inverse();
  const Array1& beta = sections.momentum_factor;
  Array1 drop(sections.x.size());
  drop(0) = 0.0;
  for (Index i = 1; i < drop.size(); ++i) {
    drop(i) = drop(i - 1) + scale * (beta(i) * thin(i) - beta(i - 1) * thin(i - 1) +
                                     0.5 * (thin(i) + thin(i - 1)) * (beta(i) - beta(i - 1)));
  }
  return drop;
}

Array1 energy_drop(const SectionsAlong& sections, const Fluid& fluid, FlowRate flow_rate) {
  check(fluid, flow_rate);
  const double scale = 0.5 * fluid.density.si() * flow_rate.si() * flow_rate.si();
  const Array1 energy = scale * sections.energy_factor / sections.area.square();
  return energy - energy(0);
}

double speed_index(double momentum_factor, double momentum_factor_slope, const Fluid& fluid,
                   FlowRate flow_rate, double area, double area_by_pressure) {
  return (momentum_factor - area * momentum_factor_slope) * fluid.density.si() * flow_rate.si() *
         flow_rate.si() * area_by_pressure / (area * area * area);
}

Array1 compliant_pressure(const SectionFamily& family, const Channel& channel, const Fluid& fluid,
                          FlowRate flow_rate, const Array1& x, Pressure outlet_pressure,
                          const std::function<WallAnswer(double x, double p)>& wall) {
  constexpr const char* kWhere = "flow past a wall that gives way";
  check(fluid, flow_rate);
  channel.validate(kWhere);
  const double width = channel.width.si(), Q = flow_rate.si();
  // A ten-thousandth of the range: the table is smooth, the difference is good to 1e-8.
  const double span = 1e-4 * (family.greatest() - family.least()).si();
  const auto gradient = [&](double at, double p) {
    const WallAnswer answer = wall(at, p);
    const CrossSection section = family.at(Length::from_si(answer.zeta));
    const double low = std::max(answer.zeta - span, family.least().si());
    const double high = std::min(answer.zeta + span, family.greatest().si());
    const double beta_slope = (family.at(Length::from_si(high)).momentum_factor -
                               family.at(Length::from_si(low)).momentum_factor) /
                              (width * (high - low));
    const double S2 = speed_index(section.momentum_factor, beta_slope, fluid, flow_rate,
                                  section.area, width * answer.by_pressure);
    if (!(S2 < 1.0)) {
      throw InputError(
          kWhere,
          fmt::format("the flow chokes at x = {:.4g} mm: its speed index S^2 is {:.3g} at {:.4g} "
                      "mL/min",
                      at * 1e3, S2, flow_rate.in(mL_per_min)),
          fmt::format(
              "Such a state cannot be steady. Check the wall's curve and the units, or give "
              "less than {:.4g} mL/min",
              flow_rate.in(mL_per_min) / std::sqrt(S2)));
    }
    const double by_place =
        fluid.density.si() * Q * Q / section.area *
        (beta_slope / section.area - section.momentum_factor / (section.area * section.area)) *
        width * answer.by_place;
    return -(section.resistance(fluid.viscosity) * Q + by_place) / (1.0 - S2);
  };
  const Index n = x.size();
  Array1 pressure(n);
  pressure(n - 1) = outlet_pressure.si();
  for (Index i = n - 1; i-- > 0;) {
    const double step = x(i) - x(i + 1), from = x(i + 1), p = pressure(i + 1);
    if (!(step < 0.0)) {
      throw InputError(kWhere, fmt::format("station {} does not follow the one before it", i + 1),
                       "Sort the stations along the flow and drop duplicates");
    }
    const double k1 = gradient(from, p);
    const double k2 = gradient(from + 0.5 * step, p + 0.5 * step * k1);
    const double k3 = gradient(from + 0.5 * step, p + 0.5 * step * k2);
    const double k4 = gradient(x(i), p + step * k3);
    pressure(i) = p + step / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
  }
  return pressure;
}

}  // namespace manoscope::flow
