#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "manoscope/calibration/constitutive_curves.hpp"
#include "manoscope/calibration/fit_curves.hpp"
#include "manoscope/inversion/intersections.hpp"
#include "manoscope/inversion/read_pressure.hpp"
#include "manoscope/inversion/test_section.hpp"
#include "manoscope/inversion/tube_law.hpp"
#include "manoscope/pipeline/compare_flow.hpp"
#include "manoscope/pipeline/stages.hpp"
#include "manoscope/results/measurement.hpp"
#include "manoscope/validation/drop_agreement.hpp"

namespace manoscope::pipeline {

/// A number that does not exist.
inline constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

/// All that was found about one run.
struct RunFindings {
  inversion::PressureReading reading;
  Array1 local_pressure, local_uncertainty;  ///< (n_x) Pa, each station on its own; flags as above
  double band_factor = 0.0;                  ///< of the simultaneous band; 0: no answer anywhere
  double half_wavelength = kMissing;         ///< m, of the non-local reading; NaN: there is none
  inversion::Stretch stretch;                ///< where the test section was looked for
  std::optional<inversion::TestSection> section;
  std::vector<inversion::Intersection> intersections;
  std::optional<validation::DropAgreement> agreement;  ///< needs a test section
  Array1 resistance_pressure;                          ///< (n_x) Pa, NaN without a test section
  double channel_resistance_drop = kMissing;           ///< Pa
  double reynolds = kMissing;
  inversion::TubeLawUnderFlow tube_law;
  std::string no_comparison;  ///< why the flow could not be compared; empty if it was
  FlowFindings flow;
};

/// The flow model that serves all runs, and why, in words.
struct ChosenModel {
  flow::FlowModel model = flow::FlowModel::section_march;
  std::string words;
};

/// The model that the options name. "auto": section-march, unless the shape of p(x), over all runs
/// together, makes another model ten times as likely; its stated error counts against a vague one.
/// Gap, viscosity and flow rate are free in that (ModelAgreement::log_likelihood): a verdict by a
/// model that was chosen because it makes up for a wrong gap would be none.
ChosenModel choose_model(const std::vector<RunFindings>& findings,
                         const CompareFlowOptions& options);

/// Copies findings into the flat arrays of the result file; stations without answer become NaN.
void store_calibration(const calibration::ConstitutiveCurves& curves,
                       const experiment::Experiment& experiment,
                       const std::vector<maps::ReducedMap>& reduced,
                       results::Measurement& measurement);
void store_runs(const std::vector<FlowRun>& runs, const std::vector<RunFindings>& findings,
                results::Measurement& measurement);
/// Models at x between their stations are straight; NaN where there is no number.
/// @param knowledge  none if flow models were not run.
void store_flow(const std::optional<FlowKnowledge>& knowledge, const ChosenModel& chosen,
                const std::vector<FlowRun>& runs, const std::vector<RunFindings>& findings,
                results::FlowChecks& checks);
void store_map_conditions(const experiment::Experiment& experiment,
                          const ReducedExperiment& reduced, results::Measurement& measurement);

/// A level whose map disagrees with the curves through the other levels.
struct LevelDoubt {
  std::string name;
  double label = 0.0, read = 0.0;  ///< Pa
  double pull = 0.0;               ///< (read - label) over the uncertainty of both
};

/// The levels whose maps, read on curves through the labels of the others as they were read, are
/// off by more than 5 standard uncertainties in the median over the stations of a stretch.
std::vector<LevelDoubt> doubtful_levels(const calibration::ConstitutiveCurves& curves,
                                        calibration::FitCurvesOptions options,
                                        const inversion::Stretch& stretch);

/// Whether a march has no pressure for a run.
bool march_broke_down(const validation::ModelComparison& comparison);

/// What the flow of one run makes doubtful, in words.
std::vector<std::string> doubt_flow(const experiment::Experiment& experiment, const FlowRun& run,
                                    const RunFindings& found);

/// Doubts worth a person's time, in words.
std::vector<std::string> find_doubts(const experiment::Experiment& experiment,
                                     const maps::FoundPlace& place,
                                     const ReducedExperiment& reduced,
                                     const calibration::ConstitutiveCurves& curves,
                                     const std::vector<LevelDoubt>& levels,
                                     const std::vector<FlowRun>& runs,
                                     const std::vector<RunFindings>& findings);

}  // namespace manoscope::pipeline
