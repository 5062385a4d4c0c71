#include "manoscope/pipeline/predict.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "manoscope/core/error.hpp"
#include "manoscope/core/parallel.hpp"
#include "manoscope/pipeline/read_runs.hpp"

namespace manoscope::pipeline {
namespace {

using experiment::Experiment;

/// Pressure at the outlet against the flow rate: a straight line through that of the runs.
class OutletLine {
 public:
  OutletLine(const std::vector<FlowRun>& runs, const std::vector<validation::Outlet>& outlets)
      : n_(static_cast<double>(runs.size())) {
    const auto n = static_cast<Index>(runs.size());
    Array1 Q(n), p(n), u(n);
    for (Index r = 0; r < n; ++r) {
      const auto at = static_cast<std::size_t>(r);
      Q[r] = runs[at].flow_rate.si();
      p[r] = outlets[at].pressure.si();
      u[r] = outlets[at].uncertainty.si();
    }
    mean_ = Q.mean();
    spread_ = (Q - mean_).square().sum();
    middle_ = p.mean();
    slope_ = spread_ > 0.0 ? ((Q - mean_) * p).sum() / spread_ : 0.0;
    const double dof = n_ - (spread_ > 0.0 ? 2.0 : 1.0);
    const double left = (p - middle_ - slope_ * (Q - mean_)).square().sum();
    variance_ = std::max(dof > 0.0 ? left / dof : 0.0, u.square().mean());
  }

  validation::Outlet at(FlowRate flow_rate) const {
    const double away = flow_rate.si() - mean_;
    const double share = 1.0 / n_ + (spread_ > 0.0 ? away * away / spread_ : 0.0);
    return {Pressure::from_si(middle_ + slope_ * away),
            Pressure::from_si(std::sqrt(variance_ * share))};
  }

 private:
  double n_, mean_ = 0.0, spread_ = 0.0, middle_ = 0.0, slope_ = 0.0, variance_ = 0.0;
};

/// What predictions need of the runs: read where it is not told.
struct FromRuns {
  ChosenModel chosen;
  std::optional<OutletLine> outlet;
};

FromRuns read_what_is_missing(const Experiment& experiment, const Calibration& calibration,
                              const FlowKnowledge& known, const PredictOptions& options,
                              const MeasureOptions& measure, int n_threads,
                              const Monitor& monitor) {
  FromRuns result;
  const bool wants_model = options.model == kAutomaticModel;
  const bool wants_outlet = !options.outlet_pressure && !experiment.rigid.outlet;
  MeasureOptions reading = measure;
  reading.flow.flow_model = options.model;
  std::vector<RunFindings> findings;
  if (!calibration.runs.empty() && (wants_model || wants_outlet)) {
    findings = read_runs(experiment, calibration, wants_model ? std::optional(known) : std::nullopt,
                         reading, n_threads, monitor);
  }
  result.chosen = choose_model(findings, reading.flow);
  if (!wants_outlet || findings.empty()) return result;
  std::vector<validation::Outlet> outlets;
  for (std::size_t r = 0; r < findings.size(); ++r) {
    outlets.push_back(outlet_of(experiment, known, calibration.runs[r], findings[r].reading,
                                findings[r].section));
  }
  result.outlet.emplace(calibration.runs, outlets);
  return result;
}

std::string outlet_words(const Experiment& experiment, const PredictOptions& options,
                         bool from_runs) {
  if (options.outlet_pressure) return "as given";
  if (experiment.rigid.outlet) return "drop of the outlet passage";
  return from_runs ? "as the runs have it" : "0 Pa: no outlet passage and no run tells it";
}

}  // namespace

void PredictOptions::validate() const {
  if (model != kAutomaticModel) flow::flow_model(model);
  if (outlet_uncertainty && *outlet_uncertainty < Pressure{}) {
    throw InputError("--outlet-uncertainty", fmt::format("is {:g} Pa", outlet_uncertainty->si()),
                     "Give 0 or more");
  }
  coupling.validate();
}

Predictions predict(const Experiment& experiment, const std::vector<FlowRate>& flow_rates,
                    const PredictOptions& options, const MeasureOptions& measure, int n_threads,
                    const Monitor& monitor) {
  options.validate();
  measure.validate();
  if (flow_rates.empty()) {
    throw InputError("--flow-rate", "is not given", "Give one or more, as \"80 mL/min\"");
  }
  for (const FlowRate flow_rate : flow_rates) {
    if (flow_rate > FlowRate{}) continue;
    throw InputError("--flow-rate", fmt::format("is {:g} mL/min", flow_rate.in(mL_per_min)),
                     "Give a positive flow rate, with x along the flow");
  }
  const Calibration calibration = calibrate(experiment, measure, n_threads, monitor);
  const FlowKnowledge known = know_flow(experiment, calibration.reduced, calibration.curves,
                                        calibration.runs, measure.flow.flow_stations);
  const FromRuns runs =
      read_what_is_missing(experiment, calibration, known, options, measure, n_threads, monitor);
  Predictions result;
  result.setup = known.words;
  result.model = runs.chosen.words;
  result.outlet = outlet_words(experiment, options, runs.outlet.has_value());
  validation::PredictFlowOptions coupling = options.coupling;
  if (!coupling.healing_length) coupling.healing_length = healing_length(calibration);
  result.flows.resize(flow_rates.size());
  parallel_for(static_cast<Index>(flow_rates.size()), n_threads, [&](Index i) {
    monitor.checkpoint();
    const FlowRate flow_rate = flow_rates[static_cast<std::size_t>(i)];
    validation::Outlet outlet =
        runs.outlet
            ? runs.outlet->at(flow_rate)
            : told_outlet(experiment, flow_rate, std::nullopt).value_or(validation::Outlet{});
    if (options.outlet_pressure) outlet = {*options.outlet_pressure, {}};
    if (options.outlet_uncertainty) outlet.uncertainty = *options.outlet_uncertainty;
    validation::FlowSetup setup = known.setup;
    setup.inlet_spread = inlet_spread(experiment, flow_rate);
    result.flows[static_cast<std::size_t>(i)] = validation::predict_flow(
        known.curves, setup, runs.chosen.model, flow_rate, outlet, gauge_of(experiment), coupling);
  });
  return result;
}

}  // namespace manoscope::pipeline
