#include <algorithm>
#include <cmath>

#include "manoscope/core/error.hpp"
#include "manoscope/core/uncertainty.hpp"
#include "manoscope/pipeline/assemble.hpp"
#include "manoscope/pipeline/at_stations.hpp"
#include "manoscope/validation/drop_fit.hpp"

namespace manoscope::pipeline {
namespace {

using results::FlowChecks;
using results::kNoNumber;

/// Row of a name in a list, added at the end if it is new.
Index row_of(std::vector<std::string>& names, const std::string& name) {
  const auto place = std::find(names.begin(), names.end(), name);
  const Index row = place - names.begin();
  if (place == names.end()) names.push_back(name);
  return row;
}

void name_rows(const std::vector<RunFindings>& findings, FlowChecks& checks) {
  for (const RunFindings& run : findings) {
    const FlowFindings& found = run.flow;
    for (const flow::PressureTerm& term : found.passages) row_of(checks.passage_term, term.name);
    if (!found.comparison) continue;
    for (const validation::ModelAgreement& one : found.comparison->models) {
      row_of(checks.flow_model, std::string(flow::flow_model_info(one.model).name));
    }
    for (const validation::Correction& one : found.comparison->corrections) {
      row_of(checks.correction, one.name);
    }
  }
}

void make_room(Index n_runs, Index n_x, FlowChecks& checks) {
  const auto rows = [](const auto& names) { return static_cast<Index>(names.size()); };
  for (Array2* table :
       {&checks.model_drop, &checks.model_drop_uncertainty, &checks.model_difference_uncertainty,
        &checks.model_en_number, &checks.model_chi_square, &checks.model_dof, &checks.model_p_value,
        &checks.model_stated_error}) {
    *table = Array2::Constant(rows(checks.flow_model), n_runs, kNoNumber);
  }
  for (Array2* table :
       {&checks.correction_drop, &checks.correction_channel_drop, &checks.correction_uncertainty}) {
    *table = Array2::Constant(rows(checks.correction), n_runs, kNoNumber);
  }
  for (Array2* table : {&checks.passage_drop, &checks.passage_drop_uncertainty}) {
    *table = Array2::Constant(rows(checks.passage_term), n_runs, kNoNumber);
  }
  for (Array2* field : {&checks.local_reynolds, &checks.wall_shear_roof, &checks.wall_shear_floor,
                        &checks.joint_pressure, &checks.joint_pressure_uncertainty,
                        &checks.predicted_pressure, &checks.predicted_pressure_uncertainty}) {
    *field = Array2::Constant(n_runs, n_x, kNoNumber);
  }
  checks.model_pressure.assign(checks.flow_model.size(), Array2::Constant(n_runs, n_x, kNoNumber));
  for (Array1* scalar :
       {&checks.reduced_reynolds, &checks.friction_drag, &checks.relative_friction_drag,
        &checks.inferred_flow_rate, &checks.inferred_flow_rate_uncertainty,
        &checks.inferred_flow_rate_p_value, &checks.inferred_viscosity,
        &checks.inferred_viscosity_uncertainty, &checks.transducer_drop,
        &checks.transducer_drop_uncertainty, &checks.parasitic_drop,
        &checks.parasitic_drop_uncertainty, &checks.compliant_drop,
        &checks.compliant_drop_uncertainty, &checks.predicted_drop,
        &checks.predicted_drop_uncertainty, &checks.predicted_en_number}) {
    *scalar = Array1::Constant(n_runs, kNoNumber);
  }
}

void store_comparison(const validation::ModelComparison& comparison, Index r,
                      const inversion::PressureReading& reading, Index end, FlowChecks& checks) {
  const Array1& x = reading.x;
  for (const validation::ModelAgreement& one : comparison.models) {
    const Index f = row_of(checks.flow_model, std::string(flow::flow_model_info(one.model).name));
    checks.model_drop(f, r) = one.drop.value;
    if (std::isfinite(one.drop.value)) {  // a march that broke down has no drop, and no bar
      checks.model_drop_uncertainty(f, r) = one.drop.standard_uncertainty();
      checks.model_difference_uncertainty(f, r) = one.uncertainty;
    }
    checks.model_en_number(f, r) = one.en_number;
    checks.model_stated_error(f, r) = one.error.half_width;
    if (one.agreement != validation::Agreement::no_verdict) {
      checks.model_chi_square(f, r) = one.along.value;
      checks.model_dof(f, r) = one.along.dof;
      checks.model_p_value(f, r) = one.along.tail;
    }
    const Array1 p = between(comparison.line.x, one.pressure, x);
    checks.model_pressure[static_cast<std::size_t>(f)].row(r) =
        p + (reading.pressure[end] - p[end]);
  }
  for (const validation::Correction& one : comparison.corrections) {
    const Index k = row_of(checks.correction, one.name);
    checks.correction_drop(k, r) = one.section.si();
    checks.correction_channel_drop(k, r) = one.channel.si();
    if (one.spread) checks.correction_uncertainty(k, r) = one.spread->si();
  }
  checks.reduced_reynolds[r] = comparison.reduced_reynolds;
  checks.local_reynolds.row(r) = between(comparison.line.x, comparison.reynolds, x);
  checks.wall_shear_roof.row(r) = between(comparison.line.x, comparison.shear.roof, x);
  checks.wall_shear_floor.row(r) = between(comparison.line.x, comparison.shear.floor, x);
  checks.friction_drag[r] = comparison.drag;
  checks.relative_friction_drag[r] = comparison.relative_drag;
}

void store_drops(const FlowRun& run, const FlowFindings& found, Index r, FlowChecks& checks) {
  if (run.transducer_drop) {
    checks.transducer_drop[r] = run.transducer_drop->si();
    if (run.transducer_uncertainty) {
      checks.transducer_drop_uncertainty[r] = run.transducer_uncertainty->si();
    }
  }
  if (found.parasitic) {
    checks.parasitic_drop[r] = found.parasitic->value;
    checks.parasitic_drop_uncertainty[r] = found.parasitic->standard_uncertainty();
  }
  for (const flow::PressureTerm& term : found.passages) {
    const Index t = row_of(checks.passage_term, term.name);
    checks.passage_drop(t, r) = term.drop.si();
    checks.passage_drop_uncertainty(t, r) = term.uncertainty.si();
  }
  if (found.compliant) {
    checks.compliant_drop[r] = found.compliant->value;
    checks.compliant_drop_uncertainty[r] = found.compliant->standard_uncertainty();
  }
  if (!found.prediction) return;
  const Estimate& predicted = found.prediction->drop;
  checks.predicted_drop[r] = predicted.value;
  checks.predicted_drop_uncertainty[r] = predicted.standard_uncertainty();
  if (!found.compliant) return;
  const double variance = std::pow(predicted.standard_uncertainty(), 2) +
                          std::pow(found.compliant->standard_uncertainty(), 2) -
                          2.0 * covariance(predicted, *found.compliant);
  if (std::isgreater(variance, 0.0)) {  // NaN where the transducer's noise is not known
    checks.predicted_en_number[r] =
        std::abs(predicted.value - found.compliant->value) / (kExpansion * std::sqrt(variance));
  }
}

/// Fits to the drops of the channel; to those of the transducer where no passage is told. Points
/// weigh by the transducer's own noise: what all runs share moves the fits as a whole.
void store_fits(const std::vector<FlowRun>& runs, FlowChecks& checks) {
  const bool compliant = checks.compliant_drop.isFinite().any();
  const Array1& drop = compliant ? checks.compliant_drop : checks.transducer_drop;
  bool weighted = true;
  std::vector<validation::DropPoint> points;
  for (Index r = 0; r < drop.size(); ++r) {
    if (!std::isfinite(drop[r])) continue;
    const FlowRun& run = runs[static_cast<std::size_t>(r)];
    const Pressure noise = run.transducer_uncertainty.value_or(Pressure{});
    weighted = weighted && noise > Pressure{};
    points.push_back({run.flow_rate, Pressure::from_si(drop[r]), noise});
  }
  try {
    const validation::QuadraticFit quadratic = validation::fit_quadratic(points);
    checks.drop_fit_linear = quadratic.linear;
    checks.drop_fit_linear_uncertainty = quadratic.linear_uncertainty;
    checks.drop_fit_quadratic = quadratic.quadratic;
    checks.drop_fit_quadratic_uncertainty = quadratic.quadratic_uncertainty;
    if (quadratic.fit.dof > 0.0 && weighted) {
      checks.drop_fit_p_value = quadratic.fit.tail;
    }
    const validation::PowerFit power = validation::fit_power(points);
    checks.drop_fit_exponent = power.exponent;
    checks.drop_fit_exponent_uncertainty = power.exponent_uncertainty;
    checks.drop_fit_power = power.at_unit;
  } catch (const InputError&) {
    // Too few flow rates, or a drop without a logarithm: no fit.
  }
}

}  // namespace

void store_flow(const std::optional<FlowKnowledge>& knowledge, const ChosenModel& chosen,
                const std::vector<FlowRun>& runs, const std::vector<RunFindings>& findings,
                results::FlowChecks& checks) {
  name_rows(findings, checks);
  const Index n_x = findings.empty() ? 0 : findings.front().reading.x.size();
  make_room(static_cast<Index>(runs.size()), n_x, checks);
  if (knowledge) {
    checks.flow_setup = knowledge->words + (chosen.words.empty() ? "" : "; model: " + chosen.words);
    checks.verdict_model = std::string(flow::flow_model_info(chosen.model).name);
  }
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const FlowFindings& found = findings[i].flow;
    const inversion::PressureReading& reading = findings[i].reading;
    const auto r = static_cast<Index>(i);
    checks.verdict.push_back(found.verdict);
    if (found.comparison) {
      store_comparison(*found.comparison, r, reading, findings[i].section->last, checks);
    }
    if (found.flow_rate) {
      checks.inferred_flow_rate[r] = found.flow_rate->value.value;
      checks.inferred_flow_rate_uncertainty[r] = found.flow_rate->value.standard_uncertainty();
      checks.inferred_flow_rate_p_value[r] = found.flow_rate->fit.tail;
    }
    if (found.viscosity) {
      checks.inferred_viscosity[r] = found.viscosity->value.value;
      checks.inferred_viscosity_uncertainty[r] = found.viscosity->value.standard_uncertainty();
    }
    if (found.joint) {
      checks.joint_pressure.row(r) =
          answers_between(*found.joint, found.joint->pressure, reading.x);
      checks.joint_pressure_uncertainty.row(r) =
          answers_between(*found.joint, found.joint->uncertainty.standard(), reading.x);
    }
    if (found.prediction) {
      checks.predicted_pressure.row(r) =
          between(found.prediction->x, found.prediction->pressure, reading.x);
      checks.predicted_pressure_uncertainty.row(r) =
          between(found.prediction->x, found.prediction->uncertainty.standard(), reading.x);
    }
    store_drops(runs[i], found, r, checks);
  }
  store_fits(runs, checks);
}

}  // namespace manoscope::pipeline
