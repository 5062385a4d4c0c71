#pragma once

#include <optional>
#include <vector>

#include "manoscope/calibration/constitutive_curves.hpp"
#include "manoscope/inversion/intersections.hpp"
#include "manoscope/inversion/read_pressure.hpp"
#include "manoscope/inversion/test_section.hpp"
#include "manoscope/pipeline/stages.hpp"
#include "manoscope/results/measurement.hpp"
#include "manoscope/validation/drop_agreement.hpp"

namespace manoscope::pipeline {

/// All that was found about one run.
struct RunFindings {
  inversion::PressureReading reading;
  inversion::Stretch stretch;  ///< where the test section was looked for
  std::optional<inversion::TestSection> section;
  std::vector<inversion::Intersection> intersections;
  std::optional<validation::DropAgreement> agreement;  ///< needs a test section
  Array1 resistance_pressure;                          ///< (n_x) Pa, NaN without a test section
  double channel_resistance_drop = 0.0;                ///< Pa
  double reynolds = 0.0;
  std::optional<Pressure> parasitic_drop;
};

/// Copies findings into the flat arrays of the result file; stations without answer become NaN.
void store_calibration(const calibration::ConstitutiveCurves& curves,
                       const experiment::Experiment& experiment,
                       const std::vector<maps::ReducedMap>& reduced,
                       results::Measurement& measurement);
void store_runs(const std::vector<FlowRun>& runs, const std::vector<RunFindings>& findings,
                results::Measurement& measurement);
void store_map_conditions(const ReducedExperiment& reduced, results::Measurement& measurement);

/// Doubts worth a person's time, in words.
std::vector<std::string> find_doubts(const experiment::Experiment& experiment,
                                     const maps::FoundPlace& place,
                                     const ReducedExperiment& reduced,
                                     const std::vector<FlowRun>& runs,
                                     const std::vector<RunFindings>& findings);

}  // namespace manoscope::pipeline
