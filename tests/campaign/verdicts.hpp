// One experiment of a campaign on the flow: are its verdicts right, is its flow rate, its drop?
#pragma once

#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "manoscope/core/uncertainty.hpp"
#include "manoscope/core/units.hpp"
#include "manoscope/experiment/experiment.hpp"
#include "manoscope/twin/scenario.hpp"
#include "manoscope/twin/solved_scenario.hpp"
#include "manoscope/validation/compare_models.hpp"
#include "tests/campaign/member.hpp"

namespace manoscope::campaign {

/// varied_scenario() whose flow is that of section-march, at the lowest, a middle and the highest
/// of its flow rates, seen by a camera of 512 pixels along the flow.
twin::Scenario verdict_scenario(const std::string& base, std::uint64_t number);

/// The same with a highest flow rate a sixth lower: the march separates at high flow rates in the
/// lower channels. None if that is no longer above the others.
std::optional<twin::Scenario> gentler_scenario(twin::Scenario scenario);

/// Standard uncertainties of what a user states, and a gap that is wrong.
inline constexpr Length kHeightUncertainty = 0.5 * um;
inline constexpr double kViscosityUncertainty = 0.005, kFlowRateUncertainty = 0.005;  // relative
inline constexpr double kWrongGap = 1.03;  // times the true one

/// The experiment as a user states it who knows how the flow enters, and gap, viscosity and flow
/// rates to these uncertainties: each off by one draw, that of the flow rates common to all runs.
void state_with_errors(experiment::Experiment& experiment, const twin::Scenario& scenario,
                       const Member& member);

/// The model that the runs chose against the reading of one run.
struct Verdict {
  static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  double difference = kNone;  ///< model less reading, over the reading
  double en_number = kNone;
  double p_value = kNone;  ///< of chi-square along x
  validation::Agreement agreement = validation::Agreement::no_verdict;
};

/// How far a number is off.
struct Miss {
  double error = Verdict::kNone;  ///< over the truth
  double pull = Verdict::kNone;   ///< over the stated standard uncertainty
};

/// What is said of one run, held against the truth.
struct JudgedRun {
  std::string run;
  double reduced_reynolds = Verdict::kNone;  ///< Re h/l
  FlowRate flow_rate{};                      ///< true
  std::string model, wrong_model;            ///< chosen with either gap
  Verdict true_gap;                          ///< stated height: true, off by its draw
  Verdict wrong_gap;                         ///< 3 % too large, and off by the same draw
  Miss inferred;                             ///< flow rate from the deflection alone
  Miss predicted;      ///< drop between the ends, from calibration and stated flow rate
  std::string silent;  ///< why something could not be told; empty if all was
};

/// Makes the experiment, measures it once as a user would, model left to the runs, with stated
/// quantities of state_with_errors(), and compares the same readings once more with the flow
/// through the wrong gap, model chosen anew. What could not be told stays NaN.
/// @param scenario  verdict_scenario() or one like it.
std::vector<JudgedRun> judge_flow(const Member& member, const twin::Scenario& scenario,
                                  const twin::SolvedScenario& solved,
                                  const std::filesystem::path& scratch);

/// The header of the table, and the rows of one member.
extern const char* const kVerdictHeader;
std::string verdict_rows(const Member& member, const std::vector<JudgedRun>& runs);

}  // namespace manoscope::campaign
