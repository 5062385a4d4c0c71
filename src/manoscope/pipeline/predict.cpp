#include "manoscope/pipeline/predict.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "manoscope/core/error.hpp"
#include "manoscope/core/parallel.hpp"
#include "manoscope/pipeline/read_runs.hpp"

namespace manoscope::pipeline {
namespace {

using experiment::Experiment;

/// Pressure at the outlet against the flow rate: a straight line through that of the runs.
class OutletLine {
 public:
  struct Point {
    double flow_rate, pressure, uncertainty;  // m3/s, Pa, Pa
  };
  explicit OutletLine(std::vector<Point> points) : points_(std::move(points)) {
    std::sort(points_.begin(), points_.end(),
              [](const Point& one, const Point& other) { return one.flow_rate < other.flow_rate; });
    const auto n = static_cast<double>(points_.size());
    for (const Point& one : points_) {
      mean_ += one.flow_rate / n;
      middle_ += one.pressure / n;
    }
    double product = 0.0, left = 0.0;
    for (const Point& one : points_) {
      spread_ += (one.flow_rate - mean_) * (one.flow_rate - mean_);
      product += (one.flow_rate - mean_) * one.pressure;
    }
    slope_ = spread_ > 0.0 ? product / spread_ : 0.0;
    for (const Point& one : points_) left += std::pow(one.pressure - line(one.flow_rate), 2);
    const double dof = n - (spread_ > 0.0 ? 2.0 : 1.0);
    scatter_ = dof > 0.0 ? left / dof : 0.0;
  }

  /// The scatter about the line, and what all runs may be off by together.
  validation::Outlet at(FlowRate flow_rate) const {
    const double Q = flow_rate.si();
    const double away = spread_ > 0.0 ? (Q - mean_) * (Q - mean_) / spread_ : 0.0;
    const double by_chance =
        std::sqrt(scatter_ * (1.0 / static_cast<double>(points_.size()) + away));
    return {Pressure::from_si(line(Q)),
            Pressure::from_si(std::hypot(by_chance, uncertainty_near(Q)))};
  }

 private:
  double line(double Q) const { return middle_ + slope_ * (Q - mean_); }
  /// That of the runs, straight between them and as Q beyond.
  double uncertainty_near(double Q) const {
    const auto above = std::find_if(points_.begin(), points_.end(),
                                    [Q](const Point& one) { return one.flow_rate >= Q; });
    if (above == points_.begin()) return above->uncertainty;
    const Point& below = *(above - 1);
    if (above == points_.end()) {
      return below.uncertainty * (below.flow_rate > 0.0 ? Q / below.flow_rate : 1.0);
    }
    const double share = (Q - below.flow_rate) / (above->flow_rate - below.flow_rate);
    return (1.0 - share) * below.uncertainty + share * above->uncertainty;
  }

  std::vector<Point> points_;
  double mean_ = 0.0, spread_ = 0.0, middle_ = 0.0, slope_ = 0.0, scatter_ = 0.0;
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
  const bool wants_outlet = !options.outlet_pressure;
  MeasureOptions reading = measure;
  reading.flow.flow_model = options.model;
  std::vector<RunFindings> findings;
  if (!calibration.runs.empty() && (wants_model || wants_outlet)) {
    findings = read_runs(experiment, calibration, wants_model ? std::optional(known) : std::nullopt,
                         reading, n_threads, monitor);
  }
  result.chosen = choose_model(findings, reading.flow);
  if (!wants_outlet || findings.empty()) return result;
  std::vector<OutletLine::Point> points;
  for (std::size_t r = 0; r < findings.size(); ++r) {
    const FlowRun& run = calibration.runs[r];
    const validation::Outlet outlet =
        outlet_of(experiment, known, run, findings[r].reading, findings[r].section);
    points.push_back({run.flow_rate.si(), outlet.pressure.si(), outlet.uncertainty.si()});
  }
  result.outlet.emplace(std::move(points));
  return result;
}

std::string outlet_words(const PredictOptions& options, bool from_runs) {
  if (options.outlet_pressure) return "as given";
  return from_runs ? "as the runs have it" : "0 Pa behind it, since no run tells it";
}

validation::Outlet outlet_at(const Experiment& experiment, const PredictOptions& options,
                             const FromRuns& runs, FlowRate flow_rate) {
  validation::Outlet outlet =
      runs.outlet ? runs.outlet->at(flow_rate) : behind_passage(experiment, flow_rate, Pressure{});
  if (options.outlet_pressure) outlet = {*options.outlet_pressure, {}};
  if (options.outlet_uncertainty) outlet.uncertainty = *options.outlet_uncertainty;
  return outlet;
}

std::vector<std::string> exact_inputs(const Experiment& experiment) {
  std::vector<std::string> names;
  if (!experiment.channel.height_uncertainty) names.emplace_back("the gap (channel.height)");
  if (!experiment.fluid.viscosity_uncertainty) names.emplace_back("the viscosity");
  if (!experiment.instrument.flow_rate_uncertainty) names.emplace_back("the flow rate");
  return names;
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
  const FlowKnowledge known =
      know_flow(experiment, calibration.reduced, calibration.curves, calibration.runs,
                measure.flow.flow_stations, options.coupling.largest_extrapolation);
  const FromRuns runs =
      read_what_is_missing(experiment, calibration, known, options, measure, n_threads, monitor);
  Predictions result;
  result.setup = known.words;
  result.model = runs.chosen.words;
  result.outlet = outlet_words(options, runs.outlet.has_value());
  result.taken_as_exact = exact_inputs(experiment);
  validation::PredictFlowOptions coupling = options.coupling;
  if (!coupling.healing_length) coupling.healing_length = healing_length(calibration);
  result.flows.resize(flow_rates.size());
  parallel_for(static_cast<Index>(flow_rates.size()), n_threads, [&](Index i) {
    monitor.checkpoint();
    const FlowRate flow_rate = flow_rates[static_cast<std::size_t>(i)];
    validation::FlowSetup setup = known.setup;
    setup.inlet_spread = inlet_spread(experiment, flow_rate);
    result.flows[static_cast<std::size_t>(i)] = validation::predict_flow(
        known.curves, setup, runs.chosen.model, flow_rate,
        [&](FlowRate at) { return outlet_at(experiment, options, runs, at); }, gauge_of(experiment),
        coupling);
  });
  for (const auto& flow : result.flows) result.doubts.push_back(doubt_prediction(flow));
  return result;
}

}  // namespace manoscope::pipeline
