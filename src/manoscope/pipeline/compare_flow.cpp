#include "manoscope/pipeline/compare_flow.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "manoscope/core/error.hpp"
#include "manoscope/inversion/thinned.hpp"
#include "manoscope/validation/joint_pressure.hpp"

namespace manoscope::pipeline {
namespace {

/// The stations at which models are run, and the ends of the test section among them.
std::vector<Index> with_ends(std::vector<Index> stations, const inversion::TestSection& section) {
  stations.push_back(section.first);
  stations.push_back(section.last);
  std::sort(stations.begin(), stations.end());
  stations.erase(std::unique(stations.begin(), stations.end()), stations.end());
  return stations;
}

Index place_of(const std::vector<Index>& stations, Index station) {
  return std::lower_bound(stations.begin(), stations.end(), station) - stations.begin();
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
  found.parasitic = flow::parasitic_estimate(
      *parts, flow_uncertainty_of(experiment).viscosity / experiment.fluid.viscosity);
  if (!run.transducer_drop) return;
  found.compliant = flow::compliant_drop(
      *run.transducer_drop, run.transducer_uncertainty.value_or(Pressure{}), *found.parasitic);
}

}  // namespace

void CompareFlowOptions::validate() const {
  flow::flow_model(verdict_model);
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
  if (!knowledge) return found;
  validation::FlowSetup setup = knowledge->setup;
  setup.inlet_spread = inlet_spread(experiment, run.flow_rate);
  flow::FlowModel model = flow::flow_model(options.verdict_model);
  const bool forward = run.flow_rate > FlowRate{};
  if (!forward && flow::flow_model_info(model).needs_forward_flow) {
    model = flow::FlowModel::momentum;
  }
  if (!section) {
    found.verdict = "no verdict: there is no test section";
  } else {
    const std::vector<Index> stations = with_ends(knowledge->stations, *section);
    const Profile state = inversion::thinned(run.profile, stations);
    const inversion::PressureReading read = inversion::thinned(reading, stations);
    const inversion::TestSection stretch{place_of(stations, section->first),
                                         place_of(stations, section->last)};
    found.comparison = attempt("flow models", found.failures, [&] {
      return validation::compare_models(setup, run.flow_rate, state, read, stretch,
                                        validation::all_models(), options.models);
    });
    found.verdict = "no verdict: the flow models could not be run";
    if (found.comparison) {
      for (const validation::ModelAgreement& one : found.comparison->models) {
        if (one.model == model) found.verdict = one.words;
      }
    }
    if (forward) {
      found.flow_rate = attempt("flow rate from the deflection", found.failures, [&] {
        return validation::infer_flow_rate(setup, model, state, read, stretch);
      });
      found.viscosity = attempt("viscosity from the deflection", found.failures, [&] {
        return validation::infer_viscosity(setup, model, run.flow_rate, state, read, stretch);
      });
    }
    if (options.joint) {
      found.joint = attempt("joint p(x)", found.failures, [&] {
        return validation::joint_pressure(setup, model, run.flow_rate, state, read, stretch);
      });
    }
  }
  found.prediction = attempt("predicted drop", found.failures, [&] {
    validation::PredictFlowOptions coupling;
    coupling.healing_length = knowledge->healing_length;
    return validation::predict_flow(
        knowledge->curves, setup, model, run.flow_rate,
        outlet_of(experiment, run.flow_rate, run.outlet_pressure, &reading), gauge_of(experiment),
        coupling);
  });
  return found;
}

}  // namespace manoscope::pipeline
