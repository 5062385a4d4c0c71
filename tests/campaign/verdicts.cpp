#include "tests/campaign/verdicts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "manoscope/core/random.hpp"
#include "manoscope/pipeline/read_runs.hpp"
#include "tests/campaign/varied_scenario.hpp"

namespace manoscope::campaign {
namespace {

constexpr flow::FlowModel kTrueModel = flow::FlowModel::section_march;

Verdict verdict_of(const pipeline::FlowFindings& found, flow::FlowModel model) {
  if (!found.comparison) return {};
  for (const validation::ModelAgreement& one : found.comparison->models) {
    if (one.model != model || one.agreement == validation::Agreement::no_verdict) continue;
    return {one.difference / found.comparison->extracted.value, one.en_number, one.along.tail,
            one.agreement};
  }
  return {};
}

Miss miss(const Estimate& told, double truth) {
  const double error = told.value - truth;
  return {error / truth, error / told.standard_uncertainty()};
}

const char* name_of(validation::Agreement agreement) {
  switch (agreement) {
    case validation::Agreement::agree:
      return "agree";
    case validation::Agreement::drop_only:
      return "drop only";
    case validation::Agreement::differ:
      return "differ";
    case validation::Agreement::no_verdict:
      break;
  }
  return "none";
}

/// Empty where there is no number.
std::string cell(double value) { return std::isfinite(value) ? fmt::format("{:.4g}", value) : ""; }

std::string cells(const Verdict& verdict) {
  return fmt::format("{},{},{},{}", cell(verdict.difference), cell(verdict.en_number),
                     cell(verdict.p_value), name_of(verdict.agreement));
}

std::string cells(const Miss& miss) {
  return fmt::format("{},{}", cell(miss.error), cell(miss.pull));
}

}  // namespace

const char* const kVerdictHeader =
    "base,wall,seed,run,reduced_reynolds,flow_rate_mL_min,difference,en_number,p_value,agreement,"
    "wrong_difference,wrong_en_number,wrong_p_value,wrong_agreement,inferred_error,inferred_pull,"
    "predicted_error,predicted_pull,model,wrong_model,silent\n";

twin::Scenario verdict_scenario(const std::string& base, std::uint64_t number) {
  twin::Scenario scenario = varied_scenario(base, number);
  scenario.solver.flow_model = std::string(flow::flow_model_info(kTrueModel).name);
  const std::vector<FlowRate> all = scenario.flow_rates;
  scenario.flow_rates = {all.front(), all[all.size() / 2], all.back()};
  scenario.camera = twin::resized(scenario.camera, "512x96");
  return scenario;
}

std::optional<twin::Scenario> gentler_scenario(twin::Scenario scenario) {
  FlowRate& highest = scenario.flow_rates.back();
  highest = (5.0 / 6.0) * highest;
  if (highest <= scenario.flow_rates[scenario.flow_rates.size() - 2]) return std::nullopt;
  return scenario;
}

void state_with_errors(experiment::Experiment& experiment, const twin::Scenario& scenario,
                       const Member& member) {
  const auto draw = [&](const char* name) {
    return RandomStream(member.own_seed(), name).normal();
  };
  experiment.channel.height = scenario.channel.height + draw("told height") * kHeightUncertainty;
  experiment.channel.height_uncertainty = kHeightUncertainty;
  experiment.fluid.viscosity =
      (1.0 + kViscosityUncertainty * draw("told viscosity")) * scenario.fluid.viscosity;
  experiment.fluid.viscosity_uncertainty = kViscosityUncertainty * scenario.fluid.viscosity;
  const double pump = 1.0 + kFlowRateUncertainty * draw("told flow rate");
  for (experiment::FlowMap& map : experiment.flow) map.flow_rate = pump * map.flow_rate;
  experiment.instrument.flow_rate_uncertainty = kFlowRateUncertainty;
  experiment.inlet.profile = flow::InletProfile::developed;
  experiment.inlet.spread = 0.0;
}

std::vector<JudgedRun> judge_flow(const Member& member, const twin::Scenario& scenario,
                                  const twin::SolvedScenario& solved,
                                  const std::filesystem::path& scratch) {
  const WrittenMember written = write_member(member, scenario, solved, scratch);
  experiment::Experiment told = experiment::read_experiment(written.folder);
  state_with_errors(told, scenario, member);
  experiment::Experiment wrong = told;
  wrong.channel.height = told.channel.height + (kWrongGap - 1.0) * scenario.channel.height;

  const pipeline::MeasureOptions options;  // as a user has them: the runs choose the model
  std::string reason;
  const pipeline::Calibration calibration = pipeline::calibrate(told, options, 1, {});
  const auto flow = pipeline::find_flow(told, calibration, options, reason);
  const auto wrong_flow = pipeline::find_flow(wrong, calibration, options, reason);
  auto findings = pipeline::read_runs(told, calibration, flow, options, 1, {});
  auto wrong_findings = findings;
  for (std::size_t r = 0; r < findings.size(); ++r) {
    wrong_findings[r].flow =
        pipeline::compare_flow(wrong, wrong_flow, calibration.runs[r], findings[r].reading,
                               findings[r].section, options.flow);
  }
  const flow::FlowModel chosen = pipeline::choose_model(findings, options.flow).model;
  const flow::FlowModel wrongly_chosen = pipeline::choose_model(wrong_findings, options.flow).model;
  std::vector<JudgedRun> judged;
  for (std::size_t r = 0; r < findings.size(); ++r) {
    const pipeline::FlowRun& run = calibration.runs[r];
    pipeline::RunFindings& found = findings[r];
    JudgedRun one;
    one.run = run.name;
    one.flow_rate = written.scalars[r].flow_rate;
    one.model = flow::flow_model_info(chosen).name;
    one.wrong_model = flow::flow_model_info(wrongly_chosen).name;
    one.true_gap = verdict_of(found.flow, chosen);
    if (found.flow.comparison) one.reduced_reynolds = found.flow.comparison->reduced_reynolds;
    one.wrong_gap = verdict_of(wrong_findings[r].flow, wrongly_chosen);
    if (flow) {
      pipeline::apply_model(told, *flow, chosen, run, found.reading, found.section, options.flow,
                            found.flow);
    }
    if (found.flow.flow_rate) {
      one.inferred = miss(found.flow.flow_rate->value, one.flow_rate.si());
    }
    if (found.flow.prediction) {
      one.predicted = miss(found.flow.prediction->drop, written.scalars[r].compliant_drop().si());
    }
    one.silent = reason;
    for (const std::string& failure : found.flow.failures) one.silent += failure + "; ";
    judged.push_back(one);
  }
  std::filesystem::remove_all(written.folder);
  return judged;
}

std::string verdict_rows(const Member& member, const std::vector<JudgedRun>& runs) {
  std::string rows;
  for (const JudgedRun& one : runs) {
    std::string silent = one.silent;
    std::replace(silent.begin(), silent.end(), ',', ';');
    rows += fmt::format("{}{},{},{:.4g},{},{},{},{},{},{},{}\n", member.name(), one.run,
                        cell(one.reduced_reynolds), one.flow_rate.in(mL_per_min),
                        cells(one.true_gap), cells(one.wrong_gap), cells(one.inferred),
                        cells(one.predicted), one.model, one.wrong_model, silent);
  }
  return rows;
}

}  // namespace manoscope::campaign
