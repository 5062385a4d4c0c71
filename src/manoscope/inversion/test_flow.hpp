// p(x) of a flow over a wall, for tests: the momentum balance of the gap, iterated with the wall.
#pragma once

#include <functional>

#include "manoscope/core/arrays.hpp"
#include "manoscope/flow/channel.hpp"
#include "manoscope/flow/duct_resistance.hpp"

namespace manoscope::inversion::test_support {

/// Friction of the exact rectangular duct and momentum flux with some beta, both under `wall`,
/// which answers to a pressure at x with a deflection there.
/// @return pressure at x, ascending stations; `outlet` at the last.
inline Array1 flow_pressure(const flow::Channel& channel, const flow::Fluid& fluid,
                            FlowRate flow_rate, const Array1& x, double outlet,
                            const std::function<Array1(const Array1&)>& wall,
                            double momentum_factor = 1.2) {
  constexpr int kIterations = 40;
  const Index n = x.size();
  Array1 p = Array1::Constant(n, outlet);
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    const Array1 gap = channel.height.si() + wall(p);
    const Array1 gradient = flow_rate.si() * flow::duct_resistance(fluid.viscosity, channel.width,
                                                                   gap, flow::DuctFormula::series);
    const Array1 dynamic = 0.5 * momentum_factor * fluid.density.si() *
                           (flow_rate.si() / (channel.width.si() * gap)).square();
    Array1 next(n);
    next[n - 1] = outlet;
    for (Index i = n - 2; i >= 0; --i) {
      next[i] = next[i + 1] + 0.5 * (x[i + 1] - x[i]) * (gradient[i] + gradient[i + 1]) +
                dynamic[i + 1] - dynamic[i];
    }
    const double moved = (next - p).abs().maxCoeff();
    p = iteration < 3 ? next : Array1(0.5 * (p + next));
    if (moved < 1e-6) break;
  }
  return p;
}

}  // namespace manoscope::inversion::test_support
