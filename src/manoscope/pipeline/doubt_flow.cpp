#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "manoscope/flow/one_dimensional.hpp"
#include "manoscope/pipeline/assemble.hpp"

namespace manoscope::pipeline {
namespace {

using Words = std::vector<std::string>;

/// Pressure that the fluid's gain of speed takes over the test section, Pa, which QR leaves out; 0
/// where it cannot be told.
double acceleration(const experiment::Experiment& experiment, const FlowRun& run,
                    const RunFindings& found) {
  const Array1& zeta = run.profile.zeta;
  if (!found.section || found.section->last >= zeta.size()) return 0.0;
  const flow::Channel channel = channel_of(experiment);
  const Length start = Length::from_si(zeta[found.section->first]);
  const Length end = Length::from_si(zeta[found.section->last]);
  if (!(channel.height + std::min(start, end) > Length{})) return 0.0;
  return flow::acceleration_drop(channel, fluid_of(experiment), run.flow_rate, start, end).si();
}

/// Whether dp_e and QR are further apart than inertia and bars can explain.
bool far_apart(const experiment::Experiment& experiment, const FlowRun& run,
               const RunFindings& found) {
  // Ten standard uncertainties, beyond what inertia explains: 1.5 times the momentum of a parabola
  // leaves room for the flow's development behind the inlet. A gap whose uncertainty is not stated
  // may be 5 % off, which is 15 % of QR.
  constexpr double kFarApart = 5.0, kRoom = 1.5, kUnknownGap = 0.15;
  const double resistance = found.agreement->resistance.value;
  const double apart = std::abs(found.agreement->extracted.value - resistance);
  double explained = kRoom * std::abs(acceleration(experiment, run, found));
  if (!experiment.channel.height_uncertainty) explained += kUnknownGap * std::abs(resistance);
  const double unexplained = apart > explained ? 1.0 - explained / apart : 0.0;
  return std::isgreater(unexplained * found.agreement->en_number, kFarApart);
}

void doubt_agreement(const experiment::Experiment& experiment, const FlowRun& run,
                     const RunFindings& found, Words& doubts) {
  if (!found.no_comparison.empty()) {
    doubts.push_back(
        fmt::format("Run {}: no hydraulic resistance, for the {}", run.name, found.no_comparison));
  }
  if (!found.agreement) return;
  const double extracted = found.agreement->extracted.value;
  if (run.flow_rate > FlowRate{} && extracted < 0.0) {
    doubts.push_back(
        fmt::format("Run {}: the pressure rises by {:.0f} Pa along the flow, and no flow rate is "
                    "read off the deflection: channel.flow points the wrong way, or the maps are "
                    "mixed up",
                    run.name, -extracted));
    return;
  }
  if (!far_apart(experiment, run, found)) return;
  doubts.push_back(fmt::format(
      "Run {}: dp_e = {:.4g} Pa and QR = {:.4g} Pa are {:.0f} times their expanded uncertainty "
      "apart{}: check the units of pressures and flow rates, channel.height, the viscosity, and "
      "that the map belongs to the run",
      run.name, extracted, found.agreement->resistance.value, found.agreement->en_number,
      experiment.channel.height_uncertainty ? ""
                                            : " (that of the gap, which is not stated, left out)"));
}

void doubt_marches(const FlowRun& run, const RunFindings& found, Words& doubts) {
  if (!found.flow.comparison) return;
  Words broken;
  for (const validation::ModelAgreement& one : found.flow.comparison->models) {
    if (std::isfinite(one.drop.value)) continue;
    broken.emplace_back(flow::flow_model_info(one.model).name);
  }
  if (broken.empty()) return;
  doubts.push_back(fmt::format(
      "Run {}: the {} broke down: no drop by it, no total of what all effects add to the drop, and "
      "the run has no say in which flow model is taken",
      run.name, fmt::join(broken, " and the ")));
}

}  // namespace

bool march_broke_down(const validation::ModelComparison& comparison) {
  return std::any_of(comparison.models.begin(), comparison.models.end(),
                     [](const auto& one) { return !std::isfinite(one.drop.value); });
}

Words doubt_flow(const experiment::Experiment& experiment, const FlowRun& run,
                 const RunFindings& found) {
  Words doubts;
  doubt_agreement(experiment, run, found, doubts);
  doubt_marches(run, found, doubts);
  return doubts;
}

}  // namespace manoscope::pipeline
