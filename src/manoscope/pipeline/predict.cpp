#include "manoscope/pipeline/predict.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "manoscope/core/error.hpp"
#include "manoscope/core/parallel.hpp"
#include "manoscope/pipeline/read_run.hpp"

namespace manoscope::pipeline {
namespace {

using experiment::Experiment;

/// Pressure at the outlet against the flow rate, by the runs of an experiment.
class OutletLine {
 public:
  OutletLine(const Experiment& experiment, const Calibration& calibration,
             const MeasureOptions& options, int n_threads, const Monitor& monitor)
      : n_(static_cast<Index>(calibration.runs.size())), Q_(n_), p_(n_), u_(n_) {
    parallel_for(n_, n_threads, [&](Index r) {
      monitor.checkpoint();
      const FlowRun& run = calibration.runs[static_cast<std::size_t>(r)];
      const RunFindings found = read_run(experiment, calibration, std::nullopt, run, options);
      const validation::Outlet outlet =
          outlet_of(experiment, run.flow_rate, run.outlet_pressure, &found.reading);
      Q_[r] = run.flow_rate.si();
      p_[r] = outlet.pressure.si();
      u_[r] = outlet.uncertainty.si();
    });
    mean_ = Q_.mean();
    spread_ = (Q_ - mean_).square().sum();
    middle_ = p_.mean();
    slope_ = spread_ > 0.0 ? ((Q_ - mean_) * p_).sum() / spread_ : 0.0;
    const Array1 rest = p_ - middle_ - slope_ * (Q_ - mean_);
    const double dof = static_cast<double>(n_) - (spread_ > 0.0 ? 2.0 : 1.0);
    const double scatter = dof > 0.0 ? rest.square().sum() / dof : 0.0;
    variance_ = std::max(scatter, u_.square().mean());
  }

  validation::Outlet at(FlowRate flow_rate) const {
    const double away = flow_rate.si() - mean_;
    const double share =
        1.0 / static_cast<double>(n_) + (spread_ > 0.0 ? away * away / spread_ : 0.0);
    return {Pressure::from_si(middle_ + slope_ * away),
            Pressure::from_si(std::sqrt(variance_ * share))};
  }

 private:
  Index n_;
  Array1 Q_, p_, u_;
  double mean_ = 0.0, spread_ = 0.0, middle_ = 0.0, slope_ = 0.0, variance_ = 0.0;
};

}  // namespace

void PredictOptions::validate() const {
  flow::flow_model(model);
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
  Predictions result;
  result.setup = known.words;
  validation::PredictFlowOptions coupling = options.coupling;
  if (!coupling.healing_length) coupling.healing_length = healing_length(calibration);
  std::optional<OutletLine> line;
  if (options.outlet_pressure) {
    result.outlet = "as given";
  } else if (experiment.rigid.outlet) {
    result.outlet = "drop of the outlet passage";
  } else if (calibration.runs.empty()) {
    result.outlet = "0 Pa: no outlet passage and no run tells it";
  } else {
    monitor.report("reading the outlet pressure", 0.0);
    line.emplace(experiment, calibration, measure, n_threads, monitor);
    result.outlet = "as read off the wall in the runs";
  }
  result.flows.resize(flow_rates.size());
  parallel_for(static_cast<Index>(flow_rates.size()), n_threads, [&](Index i) {
    monitor.checkpoint();
    const FlowRate flow_rate = flow_rates[static_cast<std::size_t>(i)];
    validation::Outlet outlet =
        line ? line->at(flow_rate) : outlet_of(experiment, flow_rate, std::nullopt, nullptr);
    if (options.outlet_pressure) outlet = {*options.outlet_pressure, {}};
    if (options.outlet_uncertainty) outlet.uncertainty = *options.outlet_uncertainty;
    validation::FlowSetup setup = known.setup;
    setup.inlet_spread = inlet_spread(experiment, flow_rate);
    result.flows[static_cast<std::size_t>(i)] =
        validation::predict_flow(known.curves, setup, flow::flow_model(options.model), flow_rate,
                                 outlet, gauge_of(experiment), coupling);
  });
  return result;
}

}  // namespace manoscope::pipeline
