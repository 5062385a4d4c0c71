#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "manoscope/inversion/repeats.hpp"
#include "manoscope/numerics/chi_square.hpp"
#include "manoscope/pipeline/checks.hpp"

namespace manoscope::pipeline {
namespace {

using results::Measurement;

/// Maps of one state, and the wall's compliance there.
struct State {
  std::string name;
  std::vector<inversion::RepeatedMap> maps;
  Array1 compliance;  ///< (n_x) m/Pa
};

/// Positions of entries that share a value, in the order of the first.
template <class Entry, class Value>
std::vector<std::vector<std::size_t>> alike(const std::vector<Entry>& entries,
                                            Value Entry::*value) {
  std::map<Value, std::size_t> place;
  std::vector<std::vector<std::size_t>> groups;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const auto [found, is_new] = place.try_emplace(entries[i].*value, groups.size());
    if (is_new) groups.emplace_back();
    groups[found->second].push_back(i);
  }
  std::erase_if(groups, [](const auto& group) { return group.size() < 2; });
  return groups;
}

/// d zeta / dp of the curves at the pressure of a level; 0 where it is not told.
Array1 level_compliance(const calibration::ConstitutiveCurves& curves, Pressure label) {
  Array1 compliance = Array1::Zero(curves.x.size());
  double pressure = label.si();
  for (std::size_t k = 0; k < curves.levels.size(); ++k) {
    if (curves.levels[k].pressure == label) pressure = curves.level_pressure[static_cast<Index>(k)];
  }
  for (Index ix = 0; ix < compliance.size(); ++ix) {
    const auto& curve = curves.curves[static_cast<std::size_t>(ix)];
    if (!curve) continue;
    compliance[ix] = curve->slope(std::clamp(pressure, curve->lowest(), curve->highest()));
  }
  return compliance;
}

/// Stated outlet pressures that differ: then the states are not the same.
bool differ(const experiment::FlowMap& a, const experiment::FlowMap& b) {
  return a.outlet_pressure && b.outlet_pressure && *a.outlet_pressure != *b.outlet_pressure;
}

std::vector<State> states(const experiment::Experiment& experiment,
                          const ReducedExperiment& reduced,
                          const calibration::ConstitutiveCurves& curves,
                          const std::vector<RunFindings>& findings, const Measurement& m) {
  std::vector<State> found;
  for (const auto& group : alike(experiment.hydrostatic, &experiment::HydrostaticMap::pressure)) {
    const auto& first = experiment.hydrostatic[group.front()];
    State state{fmt::format("level {:.6g} Pa", first.pressure.si()),
                {},
                level_compliance(curves, first.pressure)};
    for (const std::size_t i : group) {
      state.maps.push_back({&reduced.hydrostatic[i].profile,
                            experiment.hydrostatic[i].pressure_uncertainty.value_or(Pressure{})});
    }
    found.push_back(std::move(state));
  }
  for (const auto& group : alike(experiment.flow, &experiment::FlowMap::flow_rate)) {
    const auto& first = experiment.flow[group.front()];
    const auto run =
        static_cast<std::size_t>(std::find(m.run.begin(), m.run.end(), first.run) - m.run.begin());
    State state{fmt::format("flow {:.4g} mL/min", first.flow_rate.in(mL_per_min)),
                {},
                findings[run].reading.slope};
    for (const std::size_t i : group) {
      if (!differ(first, experiment.flow[i])) state.maps.push_back({&reduced.flow[i].profile, {}});
    }
    found.push_back(std::move(state));
  }
  return found;
}

}  // namespace

void store_repeats(const experiment::Experiment& experiment, const ReducedExperiment& reduced,
                   const calibration::ConstitutiveCurves& curves,
                   const std::vector<RunFindings>& findings, const inversion::Stretch& stretch,
                   Measurement& m) {
  std::vector<inversion::RepeatAgreement> agreements;
  for (const State& state : states(experiment, reduced, curves, findings, m)) {
    const auto agreement = inversion::compare_repeats(state.maps, state.compliance, stretch);
    if (!agreement) continue;
    m.repeat.push_back(state.name);
    m.repeat_maps.push_back(static_cast<int>(state.maps.size()));
    agreements.push_back(*agreement);
  }
  const auto n = static_cast<Index>(agreements.size());
  m.repeat_scatter = m.repeat_chi_square = m.repeat_dof = m.repeat_p_value = Array1(n);
  for (Index i = 0; i < n; ++i) {
    const inversion::RepeatAgreement& agreement = agreements[static_cast<std::size_t>(i)];
    m.repeat_scatter[i] = agreement.scatter;
    m.repeat_chi_square[i] = agreement.chi_square;
    m.repeat_dof[i] = agreement.dof;
    m.repeat_p_value[i] = numerics::chi_square_tail(agreement.chi_square, agreement.dof);
  }
}

std::vector<std::string> doubt_repeats(const Measurement& m) {
  constexpr double kChance = 1e-3;
  std::vector<std::string> doubts;
  for (Index i = 0; i < m.repeat_p_value.size(); ++i) {
    if (!std::isless(m.repeat_p_value[i], kChance)) continue;
    const bool is_level = m.repeat[static_cast<std::size_t>(i)].starts_with("level");
    doubts.push_back(fmt::format(
        "The {} maps of {} scatter by {:.1f} Pa about their mean, {:.1f} times their bars: {} did "
        "not stand still between them, and p(x) is less certain than told",
        m.repeat_maps[static_cast<std::size_t>(i)], m.repeat[static_cast<std::size_t>(i)],
        m.repeat_scatter[i], std::sqrt(m.repeat_chi_square[i] / m.repeat_dof[i]),
        is_level ? "gauge or wall" : "flow or wall"));
  }
  return doubts;
}

}  // namespace manoscope::pipeline
