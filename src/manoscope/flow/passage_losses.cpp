#include "manoscope/flow/passage_losses.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "manoscope/core/error.hpp"
#include "manoscope/flow/cross_section.hpp"
#include "manoscope/flow/duct_resistance.hpp"
#include "manoscope/flow/entry_flow.hpp"

namespace manoscope::flow {
namespace {

constexpr const char* kWhere = "rigid passage";
constexpr double kEdgeLoss = 0.1;  // of rho U^2/2, behind the edge of a contraction
constexpr double kDevelopmentShare = 0.1, kExpansionShare = 0.3, kStepShare = 0.5;

double rectangular(double half_width) { return std::abs(half_width) / std::numbers::sqrt3; }

/// Small over large area of a step, or nothing without one.
std::optional<double> area_ratio(const std::optional<Area>& other, bool reservoir, Area own,
                                 const char* name) {
  if (reservoir) return 0.0;
  if (!other) return std::nullopt;
  const double ratio = own / *other;
  if (ratio > 0.0 && ratio <= 1.0) return ratio;
  throw InputError(kWhere,
                   fmt::format("the section {} it has {:.4g} mm2, its own {:.4g} mm2", name,
                               other->si() * 1e6, own.si() * 1e6),
                   "Give a section at least as large as the passage's, or none");
}

/// Momentum factor of developed flow in a rectangle.
double momentum_factor(const RigidPassage& passage) {
  const bool turned = passage.height > passage.width;
  return solve_cross_section(flat_roof(turned ? passage.height : passage.width,
                                       turned ? passage.width : passage.height))
      .momentum_factor;
}

}  // namespace

std::vector<PressureTerm> passage_terms(const Fluid& fluid, FlowRate flow_rate,
                                        const RigidPassage& passage,
                                        const PassageFittings& fittings) {
  fluid.validate(kWhere);
  const double Q = flow_rate.si();
  if (!(Q > 0.0) || !std::isfinite(Q) || fittings.round_bends < 0 || fittings.mitre_bends < 0) {
    throw InputError(
        kWhere,
        fmt::format("flow rate {:g} mL/min, {} round and {} mitre bends", flow_rate.in(mL_per_min),
                    fittings.round_bends, fittings.mitre_bends),
        "Give a positive flow rate, and numbers of bends that are not negative");
  }
  std::vector<PressureTerm> terms;
  terms.push_back({"duct", "exact series of a rectangular duct",
                   passage_drop(fluid.viscosity, flow_rate, passage), Pressure{}});
  const auto add = [&](const char* name, const char* source, double drop, double half_width) {
    terms.push_back(
        {name, source, Pressure::from_si(drop), Pressure::from_si(rectangular(half_width))});
  };
  const Area own = passage.width * passage.height;
  const double w = passage.width.si(), h = passage.height.si();
  const double diameter = 2.0 * w * h / (w + h), speed = Q / own.si();
  const double head = 0.5 * fluid.density.si() * speed * speed;
  const double reynolds = speed * diameter / fluid.kinematic_viscosity().si();
  const double step = 1.5 * fluid.viscosity.si() * Q / std::pow(0.5 * diameter, 3);
  const auto upstream = area_ratio(fittings.from, fittings.from_reservoir, own, "before");
  const auto downstream = area_ratio(fittings.into, fittings.into_reservoir, own, "behind");
  if (upstream) {
    add("contraction", "energy balance, Kays (1950)", head * (1.0 - *upstream * *upstream),
        kEdgeLoss * head);
    const double development =
        head * entry_excess(entry_constants(h / w), passage.length.si() / (diameter * reynolds));
    add("development", "Shah (1978)", development, kDevelopmentShare * development);
    add("step at the entry", "Sampson, Weissberg (1962)", step, kStepShare * step);
  }
  if (downstream) {
    // beta of the large section: that of the same shape, as good as known here.
    const double beta = momentum_factor(passage);
    const double back = 2.0 * head * *downstream * beta * (1.0 - *downstream);
    add("expansion", "momentum balance, Kays (1950)", -back, kExpansionShare * back);
    add("step at the exit", "Sampson, Weissberg (1962)", step, kStepShare * step);
  }
  const double round = fittings.round_bends * head * (800.0 / reynolds + 0.25);
  if (fittings.round_bends > 0) add("round bends", "Hooper (1981)", round, round);
  const double mitre = fittings.mitre_bends * head * (1000.0 / reynolds + 1.15);
  if (fittings.mitre_bends > 0) add("mitre bends", "Hooper (1981)", mitre, mitre);
  return terms;
}

PressureTerm simulated_drop(const std::vector<SimulatedDrop>& simulations, FlowRate flow_rate) {
  constexpr const char* kSimulated = "simulated parasitic drop";
  const double Q = flow_rate.si();
  double largest = 0.0;
  bool weighted = !simulations.empty();
  for (const SimulatedDrop& one : simulations) {
    if (!(one.flow_rate.si() > 0.0)) {
      throw InputError(kSimulated,
                       fmt::format("a simulation at {:g} mL/min", one.flow_rate.in(mL_per_min)),
                       "Give simulations at positive flow rates");
    }
    largest = std::max(largest, one.flow_rate.si());
    weighted = weighted && one.uncertainty.si() > 0.0;
  }
  const bool alone = simulations.size() == 1;
  const double least = alone ? 0.99 * largest : 0.0;
  if (!(Q > least && Q > 0.0 && Q <= 1.01 * largest)) {
    throw InputError(
        kSimulated,
        fmt::format("asked at {:g} mL/min, with {} simulations up to {:g} mL/min",
                    flow_rate.in(mL_per_min), simulations.size(),
                    FlowRate::from_si(largest).in(mL_per_min)),
        "Simulate the passages at this flow rate or beyond, at two flow rates or more");
  }
  PressureTerm term{"simulation", "simulation of the passages", Pressure{}, Pressure{}};
  if (alone) {
    term.drop = (flow_rate / simulations[0].flow_rate) * simulations[0].drop;
    term.uncertainty = simulations[0].uncertainty;
    return term;
  }
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
    throw InputError(kSimulated, "all simulations are at one flow rate",
                     "Simulate a second flow rate");
  }
  const double q = Q / largest;
  const double a = (n22 * r1 - n12 * r2) / determinant, b = (n11 * r2 - n12 * r1) / determinant;
  term.drop = Pressure::from_si(a * q + b * q * q);
  if (weighted) {
    const double variance =
        (n22 * q * q - 2.0 * n12 * q * q * q + n11 * q * q * q * q) / determinant;
    term.uncertainty = Pressure::from_si(std::sqrt(variance));
  }
  return term;
}

Estimate parasitic_estimate(const std::vector<PressureTerm>& terms, double viscosity_uncertainty) {
  Estimate sum;
  for (const PressureTerm& term : terms) {
    sum.value += term.drop.si();
    sum.terms.push_back({"parasitic drop, " + term.name, "parasitic drop", term.uncertainty.si()});
  }
  sum.terms.push_back({"viscosity", "viscosity", sum.value * viscosity_uncertainty});
  return sum;
}

Estimate compliant_drop(Pressure transducer, Pressure uncertainty, const Estimate& parasitic) {
  Estimate drop;
  drop.value = transducer.si() - parasitic.value;
  drop.terms.push_back({"transducer", "transducer", uncertainty.si()});
  for (const Estimate::Term& term : parasitic.terms) {
    drop.terms.push_back({term.variable, term.source, -term.effect});
  }
  return drop;
}

}  // namespace manoscope::flow
