#pragma once

#include <optional>
#include <string>
#include <vector>

#include "manoscope/core/monitor.hpp"
#include "manoscope/experiment/experiment.hpp"
#include "manoscope/pipeline/measure_options.hpp"
#include "manoscope/validation/predict_flow.hpp"

namespace manoscope::pipeline {

struct PredictOptions {
  std::string model = kAutomaticModel;
  std::optional<Pressure> outlet_pressure;
  std::optional<Pressure> outlet_uncertainty;
  validation::PredictFlowOptions coupling;

  template <class Visitor>
  void describe(Visitor&& visit) {
    visit(
        "model", model,
        "flow model: paper, creeping, momentum, energy, developing, plane-march or section-march");
    visit("outlet-pressure", outlet_pressure,
          "gauge pressure where the channel ends; auto: as the runs have it");
    visit("outlet-uncertainty", outlet_uncertainty, "its standard uncertainty; auto: as found");
    coupling.describe(visit);
  }
  /// @throws InputError naming the first option out of range.
  void validate() const;
};

/// Pressure, deflection and drop at flow rates that were not run.
struct Predictions {
  std::vector<validation::FlowPrediction> flows;  ///< in the order asked
  std::string outlet;                             ///< where the outlet pressure comes from
  std::string setup;                              ///< section and inlet, in words
  std::string model;                              ///< why that flow model, in words
  /// Inputs whose uncertainty the experiment does not state, in words: U leaves them out.
  std::vector<std::string> taken_as_exact;
  std::vector<std::string> doubts;  ///< doubt_prediction() of each flow
};

/// Where U (k = 2) of a predicted drop is more than a quarter of it: which source most of it comes
/// from and what would mend that, in words; else empty.
std::string doubt_prediction(const validation::FlowPrediction& flow);

/// Predicts flow rates from the calibration of an experiment. Its flow runs serve to place the
/// channel, to choose the flow model (choose_model()) and, where it is not given, for the pressure
/// at the outlet: a straight line in Q through what outlet_of() finds in each, with the scatter
/// about it.
///
/// @throws InputError as calibrate(), know_flow() and validation::predict_flow(); for no flow rate,
///         or one that is not positive.
Predictions predict(const experiment::Experiment& experiment,
                    const std::vector<FlowRate>& flow_rates, const PredictOptions& options,
                    const MeasureOptions& measure = {}, int n_threads = 0,
                    const Monitor& monitor = {});

}  // namespace manoscope::pipeline
