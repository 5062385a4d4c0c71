#include "manoscope/pipeline/compare_flow.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "manoscope/core/error.hpp"
#include "manoscope/inversion/thinned.hpp"
#include "manoscope/validation/joint_pressure.hpp"

namespace manoscope::pipeline {
namespace {

/// A run at the stations at which models are run, and the ends of the test section among them.
struct ThinnedRun {
  Profile state;
  inversion::PressureReading reading;
  inversion::TestSection section;

  ThinnedRun(const FlowKnowledge& knowledge, const FlowRun& run,
             const inversion::PressureReading& whole, const inversion::TestSection& whole_section) {
    std::vector<Index> stations = knowledge.stations;
    stations.push_back(whole_section.first);
    stations.push_back(whole_section.last);
    std::sort(stations.begin(), stations.end());
    stations.erase(std::unique(stations.begin(), stations.end()), stations.end());
    const auto place = [&](Index station) {
      return std::lower_bound(stations.begin(), stations.end(), station) - stations.begin();
    };
    const flow::Channel& channel = knowledge.setup.channel;
    state = inversion::thinned(validation::bridged(run.profile, channel.length, channel.width),
                               stations);
    reading = inversion::thinned(whole, stations);
    section = {place(whole_section.first), place(whole_section.last)};
  }
};

validation::FlowSetup setup_of(const experiment::Experiment& experiment,
                               const FlowKnowledge& knowledge, const FlowRun& run) {
  validation::FlowSetup setup = knowledge.setup;
  setup.inlet_spread = inlet_spread(experiment, run.flow_rate);
  return setup;
}

/// Does one thing; keeps the reason if it cannot be done.
template <class Work>
auto attempt(const char* what, std::vector<std::string>& failures, Work work)
    -> std::optional<decltype(work())> {
  try {
    return work();
  } catch (const InputError& error) {
    failures.push_back(fmt::format("{}: {} {}", what, error.where(), error.found()));
    return std::nullopt;
  }
}

void take_passages(const experiment::Experiment& experiment, const FlowRun& run,
                   FlowFindings& found) {
  const auto parts = attempt("parasitic drop", found.failures,
                             [&] { return passages(experiment, run.flow_rate); });
  if (!parts || parts->empty()) return;
  found.passages = *parts;
  found.parasitic = flow::parasitic_estimate(*parts, passage_uncertainty_of(experiment));
  if (!run.transducer_drop) return;
  found.compliant =
      flow::compliant_drop(*run.transducer_drop, run.transducer_uncertainty, *found.parasitic);
}

}  // namespace

void CompareFlowOptions::validate() const {
  if (flow_model != kAutomaticModel) flow::flow_model(flow_model);
  if (flow_stations < 20) {
    throw InputError("--flow-stations", fmt::format("is {}", flow_stations),
                     "Give a number of 20 or more");
  }
  models.validate();
}

FlowFindings compare_flow(const experiment::Experiment& experiment,
                          const std::optional<FlowKnowledge>& knowledge, const FlowRun& run,
                          const inversion::PressureReading& reading,
                          const std::optional<inversion::TestSection>& section,
                          const CompareFlowOptions& options) {
  FlowFindings found;
  take_passages(experiment, run, found);
  if (!knowledge || !section) return found;
  found.comparison = attempt("flow models", found.failures, [&] {
    const ThinnedRun thin(*knowledge, run, reading, *section);
    return validation::compare_models(setup_of(experiment, *knowledge, run), run.flow_rate,
                                      thin.state, thin.reading, thin.section,
                                      validation::all_models(), options.models);
  });
  return found;
}

void apply_model(const experiment::Experiment& experiment, const FlowKnowledge& knowledge,
                 flow::FlowModel model, const FlowRun& run,
                 const inversion::PressureReading& reading,
                 const std::optional<inversion::TestSection>& section,
                 const CompareFlowOptions& options, FlowFindings& found) {
  const bool forward = run.flow_rate > FlowRate{};
  if (!forward && flow::flow_model_info(model).needs_forward_flow) {
    model = flow::FlowModel::momentum;
  }
  const validation::FlowSetup setup = setup_of(experiment, knowledge, run);
  found.verdict = section ? "no verdict: the flow models could not be run"
                          : "no verdict: there is no test section";
  if (found.comparison) {
    for (const validation::ModelAgreement& one : found.comparison->models) {
      if (one.model == model) found.verdict = one.words;
    }
  }
  if (section) {
    const ThinnedRun thin(knowledge, run, reading, *section);
    // A pressure that rises along the flow is told as a doubt; it has no flow rate.
    if (forward && reading.pressure[section->first] > reading.pressure[section->last]) {
      found.flow_rate = attempt("flow rate from the deflection", found.failures, [&] {
        return validation::infer_flow_rate(setup, model, thin.state, thin.reading, thin.section);
      });
      found.viscosity = attempt("viscosity from the deflection", found.failures, [&] {
        return validation::infer_viscosity(setup, model, run.flow_rate, thin.state, thin.reading,
                                           thin.section);
      });
    }
    if (options.joint) {
      found.joint = attempt("joint p(x)", found.failures, [&] {
        return validation::joint_pressure(setup, model, run.flow_rate, thin.state, thin.reading,
                                          thin.section);
      });
    }
  }
  found.prediction = attempt("predicted drop", found.failures, [&] {
    validation::PredictFlowOptions coupling;
    coupling.healing_length = knowledge.healing_length;
    return validation::predict_flow(knowledge.curves, setup, model, run.flow_rate,
                                    outlet_of(experiment, knowledge, run, reading, section),
                                    gauge_of(experiment), coupling);
  });
}

}  // namespace manoscope::pipeline
