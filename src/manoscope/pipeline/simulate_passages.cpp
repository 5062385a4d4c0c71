#include "manoscope/pipeline/simulate_passages.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "manoscope/core/error.hpp"
#include "manoscope/core/suggest.hpp"
#include "manoscope/flow/passage_losses.hpp"
#include "manoscope/pipeline/flow_knowledge.hpp"

namespace manoscope::pipeline {
namespace {

using experiment::Experiment;
using experiment::Passage;

flow::RigidPassage sizes(const Passage& passage) {
  return {passage.length, passage.width, passage.height,
          passage.height_uncertainty.value_or(Length{})};
}

/// A section between passage and channel has no length: only the channel itself can be meant.
void check_joint(const Experiment& experiment, const Passage& passage, bool is_inlet) {
  const auto& fittings = passage.fittings;
  const auto& area = is_inlet ? fittings.into : fittings.from;
  const bool reservoir = is_inlet ? fittings.into_reservoir : fittings.from_reservoir;
  const flow::Area channel = experiment.channel.width * experiment.channel.height;
  const flow::Area own = passage.width * passage.height;
  constexpr double kSame = 0.05;
  const auto is = [&](flow::Area other) { return std::abs(*area / other - 1.0) <= kSame; };
  if (!reservoir && (!area || is(channel) || is(own))) return;
  const char* const key = is_inlet ? "into" : "from";
  throw InputError(
      fmt::format("rigid.{}.{}{}", is_inlet ? "inlet" : "outlet", key,
                  reservoir ? "_reservoir" : ""),
      reservoir ? std::string("a chamber lies between passage and channel, of unknown shape")
                : fmt::format("a section of {:.4g} mm2 lies between passage and channel, which has "
                              "{:.4g} mm2",
                              area->si() * 1e6, channel.si() * 1e6),
      "Passages are simulated joined to the channel: leave the key out, or leave these passages to "
      "their formulas");
}

/// What lies at the gauge's end of the passage.
void add_far_end(const Passage& passage, GivenPassage& given) {
  constexpr double kReservoir = 6.0;
  const auto& fittings = passage.fittings;
  const auto& area = given.is_inlet ? fittings.from : fittings.into;
  if (given.is_inlet ? fittings.from_reservoir : fittings.into_reservoir) {
    const Length more = kReservoir * std::min(passage.width, passage.height);
    given.beyond_width = passage.width + 2.0 * more;
    given.beyond_height = passage.height + more;
  } else if (area && *area > passage.width * passage.height) {
    const double factor = std::sqrt(*area / (passage.width * passage.height));
    given.beyond_width = factor * passage.width;
    given.beyond_height = factor * passage.height;
  }
  given.port = passage.port.value_or(Length{});
  given.port_at_side = passage.port_at_side;
}

GivenPassage given_passage(const Experiment& experiment, const Passage& passage, bool is_inlet) {
  GivenPassage given;
  given.is_inlet = is_inlet;
  given.channel = channel_of(experiment);
  given.passage = sizes(passage);
  given.fluid = fluid_of(experiment);
  add_far_end(passage, given);
  return given;
}

/// Adds what formulas tell of a passage: bends, and what its height does.
void add_formulas(const Experiment& experiment, const Passage& passage, ParasiticDrop& drop) {
  const flow::Fluid fluid = fluid_of(experiment);
  for (const flow::PressureTerm& term :
       flow::passage_terms(fluid, drop.flow_rate, sizes(passage), passage.fittings)) {
    drop.height_effect += term.height_effect.si();
  }
  flow::PassageFittings bends;
  bends.round_bends = passage.fittings.round_bends;
  bends.mitre_bends = passage.fittings.mitre_bends - (passage.port ? 1 : 0);
  for (const flow::PressureTerm& term :
       flow::passage_terms(fluid, drop.flow_rate, sizes(passage), bends)) {
    if (term.name == "duct") continue;
    drop.bends += term.drop.si();
    drop.bends_uncertainty += term.uncertainty.si();
  }
}

std::vector<std::string> run_names(const Experiment& experiment) {
  std::vector<std::string> names;
  for (const experiment::FlowMap& map : experiment.flow) {
    if (std::find(names.begin(), names.end(), map.run) == names.end()) names.push_back(map.run);
  }
  return names;
}

std::string pascals(double value) { return fmt::format("{:.6g} Pa", value); }

}  // namespace

double ParasiticDrop::uncertainty() const {
  return std::hypot(inlet.drop_uncertainty + outlet.drop_uncertainty, bends_uncertainty,
                    height_effect);
}

std::vector<FlowRate> flow_rates_of(const Experiment& experiment,
                                    const std::vector<std::string>& names) {
  const std::vector<std::string> known = run_names(experiment);
  const bool all = std::find(names.begin(), names.end(), "all") != names.end();
  for (const std::string& name : names) {
    if (name == "all" || std::find(known.begin(), known.end(), name) != known.end()) continue;
    throw InputError(
        "--run",
        fmt::format("\"{}\" is no run of {}{}", name, experiment.name, did_you_mean(name, known)),
        fmt::format("Choose from {}, or all", fmt::join(known, ", ")));
  }
  std::vector<FlowRate> rates;
  for (const experiment::FlowMap& map : experiment.flow) {
    if (!all && std::find(names.begin(), names.end(), map.run) == names.end()) continue;
    if (!(map.flow_rate > FlowRate{})) {
      throw InputError(fmt::format("run {}", map.run),
                       fmt::format("its flow rate is {:g} mL/min", map.flow_rate.in(mL_per_min)),
                       "Passages are simulated in forward flow: choose other runs");
    }
    rates.push_back(map.flow_rate);
  }
  std::sort(rates.begin(), rates.end());
  constexpr double kSame = 1e-9;  // the same value in two units differs by round-off
  rates.erase(std::unique(rates.begin(), rates.end(),
                          [](FlowRate a, FlowRate b) { return b / a < 1.0 + kSame; }),
              rates.end());
  return rates;
}

std::vector<ParasiticDrop> simulate_passages(const Experiment& experiment,
                                             const std::vector<FlowRate>& flow_rates,
                                             const PassageSolver& solver, const Monitor& monitor) {
  const auto& rigid = experiment.rigid;
  if (!rigid.inlet && !rigid.outlet) {
    throw InputError(experiment.file.string(), "has neither rigid.inlet nor rigid.outlet",
                     "Describe the passages in a section [rigid]");
  }
  if (rigid.inlet) check_joint(experiment, *rigid.inlet, true);
  if (rigid.outlet) check_joint(experiment, *rigid.outlet, false);
  std::vector<ParasiticDrop> drops;
  for (const FlowRate rate : flow_rates) {
    ParasiticDrop drop;
    drop.flow_rate = rate;
    drop.inlet.converged = drop.outlet.converged = true;
    const auto solve = [&](const std::optional<Passage>& passage, bool is_inlet) {
      if (!passage) return;
      GivenPassage given = given_passage(experiment, *passage, is_inlet);
      given.flow_rate = rate;
      (is_inlet ? drop.inlet : drop.outlet) = solver(given);
      add_formulas(experiment, *passage, drop);
    };
    solve(rigid.inlet, true);
    solve(rigid.outlet, false);
    Experiment by_formula = experiment;
    by_formula.rigid.simulated.clear();
    const Estimate formula = flow::parasitic_estimate(passages(by_formula, rate), {});
    drop.formula = formula.value;
    drop.formula_uncertainty = formula.standard_uncertainty();
    drops.push_back(drop);
    monitor.checkpoint();
  }
  return drops;
}

std::string simulated_key(const std::vector<ParasiticDrop>& drops) {
  std::string text = "simulated = [\n";
  for (const ParasiticDrop& drop : drops) {
    text += fmt::format(
        "  {{flow_rate = \"{:.9g} mL/min\", drop = \"{}\", uncertainty = \"{}\"}},\n",
        drop.flow_rate.in(mL_per_min), pascals(drop.drop()), pascals(drop.uncertainty()));
  }
  return text + "]\n";
}

std::string passages_table(const std::vector<ParasiticDrop>& drops) {
  std::string text = "flow_rate_m3_s";
  for (const char* part : {"inlet", "outlet", "bends", "parasitic", "formula"}) {
    text += fmt::format(",{0}_drop_Pa,{0}_drop_uncertainty_Pa", part);
  }
  text += '\n';
  for (const ParasiticDrop& d : drops) {
    text += fmt::format("{:.9g}", d.flow_rate.si());
    for (const double value :
         {d.inlet.drop, d.inlet.drop_uncertainty, d.outlet.drop, d.outlet.drop_uncertainty, d.bends,
          d.bends_uncertainty, d.drop(), d.uncertainty(), d.formula, d.formula_uncertainty}) {
      text += fmt::format(",{:.9g}", value);
    }
    text += '\n';
  }
  return text;
}

std::vector<std::string> passage_doubts(const Experiment& experiment,
                                        const std::vector<ParasiticDrop>& drops) {
  std::vector<std::string> doubts;
  for (const ParasiticDrop& d : drops) {
    if (d.converged()) continue;
    doubts.push_back(fmt::format(
        "at {:.4g} mL/min the passages have not converged: {:.2g} % uncertain by the mesh (inlet), "
        "{:.2g} % (outlet): take --order 3, or accept it (--tolerance)",
        d.flow_rate.in(mL_per_min), 100.0 * d.inlet.drop_uncertainty / std::abs(d.drop()),
        100.0 * d.outlet.drop_uncertainty / std::abs(d.drop())));
  }
  if (drops.size() == 1) {
    doubts.emplace_back(
        "one flow rate serves runs at that flow rate alone: simulate a second (--run all) for all "
        "others");
  }
  if (!experiment.rigid.simulated.empty()) {
    doubts.emplace_back("rigid.simulated is there already: it stays in use until it is replaced");
  }
  return doubts;
}

}  // namespace manoscope::pipeline
