#include "manoscope/twin/coupled.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "manoscope/core/error.hpp"
#include "manoscope/flow/duct_resistance.hpp"

namespace manoscope::twin {
namespace {

constexpr const char* kWhere = "coupled flow";
/// Largest relative change of the drop between n/2 and n steps; the error of n steps is a
/// fifteenth.
constexpr double kMostChange = 1e-3;

}  // namespace

void CoupledOptions::validate() const {
  if (steps < 10 || steps > 10'000'000) {
    throw InputError(kWhere, fmt::format("steps is {}", steps), "Choose 10 to 10000000 steps");
  }
}

CoupledFlow solve_coupled(const flow::Channel& channel, const flow::Fluid& fluid,
                          const wall::TaperedMembrane& wall, FlowRate flow_rate,
                          Pressure outlet_pressure, const CoupledOptions& options) {
  options.validate();
  channel.validate(kWhere);
  fluid.validate(kWhere);
  if (std::abs(wall.length() / channel.length - 1.0) > 1e-12) {
    throw InputError(kWhere,
                     fmt::format("the wall is {:g} mm long, the channel {:g} mm",
                                 wall.length().in(mm), channel.length.in(mm)),
                     "Give both the same length");
  }
  if (!std::isfinite(flow_rate.si()) || !std::isfinite(outlet_pressure.si())) {
    throw InputError(kWhere, "flow rate or outlet pressure is not finite",
                     "Give values such as \"70 mL/min\" and \"300 Pa\"");
  }
  const flow::DuctFormula formula =
      options.exact_duct ? flow::DuctFormula::series : flow::DuctFormula::wide_duct;
  const auto slope = [&](double x, double p) {
    const double gap = channel.height.si() + wall.deflection(x, p);
    if (!(gap > 0.0)) {
      throw InputError(
          kWhere,
          fmt::format("the wall touches the floor at x = {:.4g} mm under {:.4g} Pa, {:.3g} mL/min",
                      x * 1e3, p, flow_rate.in(mL_per_min)),
          "Raise the channel height or the outlet pressure, or lower the preload of the wall");
    }
    return -flow_rate.si() *
           flow::duct_resistance(fluid.viscosity, channel.width, Length::from_si(gap), formula);
  };

  const double length = channel.length.si();
  const auto march = [&](Index n) {
    const double step = length / static_cast<double>(n);
    Array1 pressure(n + 1);
    pressure(n) = outlet_pressure.si();
    for (Index i = n; i > 0; --i) {
      const double x = static_cast<double>(i) * step, p = pressure(i);
      const double k1 = slope(x, p);
      const double k2 = slope(x - 0.5 * step, p - 0.5 * step * k1);
      const double k3 = slope(x - 0.5 * step, p - 0.5 * step * k2);
      const double k4 = slope(static_cast<double>(i - 1) * step, p - step * k3);
      pressure(i - 1) = p - step / 6.0 * (k1 + 2.0 * (k2 + k3) + k4);
    }
    return pressure;
  };
  const Index n = options.steps;
  Array1 pressure = march(n);
  const double drop = std::abs(pressure(0) - outlet_pressure.si());
  const double change = std::abs(pressure(0) - march(n / 2)(0));
  if (!(change <= kMostChange * drop)) {
    throw InputError(kWhere,
                     fmt::format("{} steps do not resolve the flow at {:.3g} mL/min: half of them "
                                 "move the drop of {:.4g} Pa by {:.3g} Pa",
                                 n, flow_rate.in(mL_per_min), drop, change),
                     "Raise the number of steps, or widen a channel that is nearly closed");
  }
  Array1 deflection(n + 1);
  const double step = length / static_cast<double>(n);
  for (Index i = 0; i <= n; ++i) {
    deflection(i) = wall.deflection(static_cast<double>(i) * step, pressure(i));
  }
  return {UniformCurve(channel.length, std::move(pressure)),
          UniformCurve(channel.length, std::move(deflection))};
}

}  // namespace manoscope::twin
