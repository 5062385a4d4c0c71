#pragma once

#include <optional>
#include <string>
#include <vector>

#include "manoscope/inversion/read_pressure.hpp"
#include "manoscope/inversion/test_section.hpp"
#include "manoscope/pipeline/flow_knowledge.hpp"
#include "manoscope/pipeline/stages.hpp"
#include "manoscope/validation/compare_models.hpp"
#include "manoscope/validation/infer_flow.hpp"
#include "manoscope/validation/predict_flow.hpp"

namespace manoscope::pipeline {

/// Leaves the choice of the flow model to choose_model().
inline constexpr const char* kAutomaticModel = "auto";

/// How a reading is held against the flow.
struct CompareFlowOptions {
  bool flow_models = true;  ///< off: eq. (4) alone
  std::string flow_model = kAutomaticModel;
  int flow_stations = 120;
  bool joint = false;
  validation::CompareModelsOptions models;

  template <class Visitor>
  void describe(Visitor&& visit) {
    visit("flow-models", flow_models,
          "hold the reading against every flow model, not against eq. (4) alone");
    visit("flow-model", flow_model,
          "flow model of the verdict, of the flow rate from the deflection and of the prediction; "
          "auto: section-march, unless the runs make another ten times as likely");
    visit("flow-stations", flow_stations, "stations at which flow models are run, 20 or more");
    visit("joint", joint,
          "give p(x) that satisfies the flow model as well, beside the reading: no longer "
          "independent of the flow");
    models.describe(visit);
  }
  /// @throws InputError naming the first option out of range.
  void validate() const;
};

/// What the flow models say of one run.
struct FlowFindings {
  std::optional<validation::ModelComparison> comparison;
  std::optional<validation::InferredFlow> flow_rate, viscosity;
  std::optional<validation::FlowPrediction> prediction;
  std::optional<inversion::PressureReading> joint;  ///< at FlowKnowledge::stations
  std::vector<flow::PressureTerm> passages;
  std::optional<Estimate> parasitic, compliant;  ///< Pa
  std::string verdict;                           ///< or why there is none
  std::vector<std::string> failures;             ///< what could not be done, each with its reason
};

/// Holds the reading of one run against every flow model, and the transducer against the rigid
/// passages. What cannot be done is told, and the rest goes on.
/// @param knowledge  none if flow models cannot be run at all: passages and transducer alone then.
/// @param section    of the reading; without one there is no comparison.
FlowFindings compare_flow(const experiment::Experiment& experiment,
                          const std::optional<FlowKnowledge>& knowledge, const FlowRun& run,
                          const inversion::PressureReading& reading,
                          const std::optional<inversion::TestSection>& section,
                          const CompareFlowOptions& options);

/// The verdict by one model; flow rate and viscosity from the deflection, the drop predicted from
/// the calibration, and p(x) that satisfies the model if asked for.
void apply_model(const experiment::Experiment& experiment, const FlowKnowledge& knowledge,
                 flow::FlowModel model, const FlowRun& run,
                 const inversion::PressureReading& reading,
                 const std::optional<inversion::TestSection>& section,
                 const CompareFlowOptions& options, FlowFindings& found);

}  // namespace manoscope::pipeline
