#include "manoscope/flow/simulated_drop.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "manoscope/core/error.hpp"

namespace manoscope::flow {
namespace {

constexpr const char* kWhere = "simulated parasitic drop";

/// What a list of simulations is good for.
struct Reach {
  double largest = 0.0;   ///< m3/s
  bool weighted = false;  ///< every simulation has an uncertainty
};

Reach checked(const std::vector<SimulatedDrop>& simulations, FlowRate flow_rate) {
  Reach reach{0.0, !simulations.empty()};
  for (const SimulatedDrop& one : simulations) {
    if (!(one.flow_rate.si() > 0.0)) {
      throw InputError(kWhere,
                       fmt::format("a simulation at {:g} mL/min", one.flow_rate.in(mL_per_min)),
                       "Give simulations at positive flow rates");
    }
    reach.largest = std::max(reach.largest, one.flow_rate.si());
    reach.weighted = reach.weighted && one.uncertainty.si() > 0.0;
  }
  const double Q = flow_rate.si();
  const double least = simulations.size() == 1 ? 0.99 * reach.largest : 0.0;
  if (Q > least && Q > 0.0 && Q <= 1.01 * reach.largest) return reach;
  throw InputError(kWhere,
                   fmt::format("asked at {:g} mL/min, with {} simulations up to {:g} mL/min",
                               flow_rate.in(mL_per_min), simulations.size(),
                               FlowRate::from_si(reach.largest).in(mL_per_min)),
                   "Simulate the passages at this flow rate or beyond, at two flow rates or more");
}

PressureTerm empty_term() {
  PressureTerm term;
  term.name = term.formula = "simulation";
  term.source = "simulation of the passages";
  return term;
}

PressureTerm from_one(const SimulatedDrop& simulation, FlowRate flow_rate) {
  PressureTerm term = empty_term();
  term.drop = (flow_rate / simulation.flow_rate) * simulation.drop;
  term.uncertainty = simulation.uncertainty;
  term.by_flow_rate = 2.0 * term.drop;
  term.by_viscosity = term.drop;
  return term;
}

}  // namespace

PressureTerm simulated_drop(const std::vector<SimulatedDrop>& simulations, FlowRate flow_rate) {
  const auto [largest, weighted] = checked(simulations, flow_rate);
  if (simulations.size() == 1) return from_one(simulations[0], flow_rate);
  // Normal equations of dp/Q0 = a q + b q^2 with q = Q/Q0: two unknowns, well scaled.
  double n11 = 0.0, n12 = 0.0, n22 = 0.0, r1 = 0.0, r2 = 0.0;
  for (const SimulatedDrop& one : simulations) {
    const double q = one.flow_rate.si() / largest, u = weighted ? one.uncertainty.si() : 1.0;
    n11 += q * q / (u * u);
    n12 += q * q * q / (u * u);
    n22 += q * q * q * q / (u * u);
    r1 += q * one.drop.si() / (u * u);
    r2 += q * q * one.drop.si() / (u * u);
  }
  const double determinant = n11 * n22 - n12 * n12;
  if (!(determinant > 1e-9 * n11 * n22)) {  // Cauchy-Schwarz: 0 if all flow rates are one
    throw InputError(kWhere, "all simulations are at one flow rate", "Simulate a second flow rate");
  }
  const double q = flow_rate.si() / largest;
  const double a = (n22 * r1 - n12 * r2) / determinant, b = (n11 * r2 - n12 * r1) / determinant;
  PressureTerm term = empty_term();
  term.drop = Pressure::from_si(a * q + b * q * q);
  term.by_viscosity = Pressure::from_si(a * q);
  term.by_flow_rate = Pressure::from_si(a * q + 2.0 * b * q * q);
  if (weighted) {
    const double variance =
        (n22 * q * q - 2.0 * n12 * q * q * q + n11 * q * q * q * q) / determinant;
    term.uncertainty = Pressure::from_si(std::sqrt(variance));
  }
  return term;
}

}  // namespace manoscope::flow
