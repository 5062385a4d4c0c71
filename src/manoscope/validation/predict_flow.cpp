#include "manoscope/validation/predict_flow.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <string>

#include "manoscope/core/error.hpp"
#include "manoscope/validation/flow_coupling.hpp"

namespace manoscope::validation {
namespace {

constexpr const char* kWhere = "predicted flow";

void set_flags(FlowPrediction& result, const FlowCoupling& coupling,
               const flow::ModelledPressure& modelled) {
  const CurvedWall& wall = coupling.wall();
  const Array1& p = result.pressure;
  result.flags = Flags1::Zero(p.size());
  const Array1 at = coupling.felt(p), slope = coupling.slopes(p);
  bool doubt = false;
  for (Index i = p.size(); i-- > 0;) {
    FlagBits& flags = result.flags[i];
    if (doubt) flags |= PredictionFlag::downstream_doubt;
    if (wall.is_outside(i, at[i])) flags |= PredictionFlag::out_of_calibration;
    if (slope[i] < 0.0) flags |= PredictionFlag::falling_curve;
    doubt = doubt || flags != 0;
    if (modelled.flags[i] != 0) flags |= PredictionFlag::separated;
    if (result.speed_index[i] >= 1.0) flags |= PredictionFlag::nearly_choked;
  }
}

/// The errors of wall and model in p, zeta and the drop.
class Propagation {
 public:
  Propagation(const FlowCoupling& coupling, const ModelledRun& run, FlowPrediction& result)
      : coupling_(coupling), run_(run), result_(result), slopes_(coupling.slopes(result.pressure)) {
    const Index n = result.pressure.size();
    solver_.compute(Matrix::Identity(n, n) -
                    run.sensitivity.by_zeta * slopes_.matrix().asDiagonal() * coupling.spread());
    result.uncertainty.independent = result.zeta_uncertainty.independent = none_ = Array1::Zero(n);
  }

  void add_curves(const inversion::GaugeErrors& gauge) {
    const Uncertainty errors = coupling_.wall().errors(coupling_.felt(result_.pressure), gauge);
    for (const ErrorMode& mode : errors.modes) add(mode.variable, mode.source, mode.effect, none_);
    for (Index i = 0; i < none_.size(); ++i) {
      Array1 one = none_;
      one[i] = errors.independent[i];
      add(fmt::format("noise of the curves at station {}",
                      coupling_.wall().station()[static_cast<std::size_t>(i)]),
          "pixel noise", one, none_);
    }
  }

  void add_flow(const Outlet& outlet) {
    const FlowSetup& setup = coupling_.setup();
    const FlowUncertainty& u = setup.uncertainty;
    const flow::FlowSensitivity& by = run_.sensitivity;
    add("channel height", "channel height", none_, u.height.si() * by.by_height);
    add("viscosity", "viscosity", none_, (u.viscosity / setup.fluid.viscosity) * by.by_viscosity);
    add("flow rate", "flow rate", none_, u.flow_rate * by.by_flow_rate);
    add("outlet pressure", "outlet pressure", none_,
        Array1::Constant(none_.size(), outlet.uncertainty.si()));
    const Array1 fall = run_.pressure();  // p - p_out
    const double standard = run_.error.standard();
    const std::string name(flow::flow_model_info(coupling_.model()).name);
    add("flow model " + name, "flow model", none_, standard * fall);
    if (fall[0] != 0.0) {
      const Array1 share = fall / fall[0];
      add("flow model " + name + ", bend", "flow model", none_,
          standard * fall[0] * 4.0 * share * (1.0 - share));
    }
    add("inlet profile", "inlet profile", none_, run_.inlet_effect);
  }

 private:
  void add(const std::string& variable, const std::string& source, const Array1& of_zeta,
           const Array1& of_model) {
    if ((of_zeta == 0.0).all() && (of_model == 0.0).all()) return;
    const Array1 effect =
        solver_.solve(run_.sensitivity.by_zeta * of_zeta.matrix() + of_model.matrix()).array();
    result_.uncertainty.modes.push_back({variable, source, effect});
    result_.zeta_uncertainty.modes.push_back(
        {variable, source, slopes_ * coupling_.felt(effect) + of_zeta});
  }

  const FlowCoupling& coupling_;
  const ModelledRun& run_;
  FlowPrediction& result_;
  Array1 slopes_, none_;
  Eigen::PartialPivLU<Matrix> solver_;
};

FlowPrediction told(const FlowCoupling& coupling, const CoupledState& state,
                    const inversion::GaugeErrors& gauge) {
  FlowPrediction result;
  result.model = coupling.model();
  result.flow_rate = state.flow_rate;
  result.x = coupling.wall().x();
  result.station = coupling.wall().station();
  result.steps = state.steps;
  result.pressure = state.pressure;
  const WallLine line = coupling.wall().line(coupling.felt(state.pressure));
  result.zeta = line.zeta;
  result.speed_index = coupling.speed_index(state);
  const ModelledRun run = modelled_run(coupling.model(), coupling.setup(), state.flow_rate, line);
  result.error = run.error;
  set_flags(result, coupling, run.sensitivity.modelled);
  Propagation propagation(coupling, run, result);
  propagation.add_curves(gauge);
  propagation.add_flow(state.outlet);
  const Index last = state.pressure.size() - 1;
  result.drop.value = state.pressure[0] - state.pressure[last];
  for (const ErrorMode& mode : result.uncertainty.modes) {
    result.drop.terms.push_back({mode.variable, mode.source, mode.effect[0] - mode.effect[last]});
  }
  return result;
}

/// The largest number of two digits that is no larger, and the one before it.
double two_digits(double value) {
  const double unit = std::pow(10.0, std::floor(std::log10(value)) - 1.0);
  return std::floor(value / unit * (1.0 + 1e-12)) * unit;
}
double one_less(double value) { return two_digits(value * (1.0 - 1e-6)); }

/// The flow rates that have an answer, in the direction of the one asked.
class Answers {
 public:
  Answers(const FlowCoupling& coupling, const OutletAt& outlet, const inversion::GaugeErrors& gauge,
          FlowRate asked)
      : coupling_(coupling), outlet_(outlet), gauge_(gauge), asked_(asked) {}

  /// From the state at rest, or by way of lower flow rates.
  /// @throws InputError that names the largest flow rate with an answer.
  FlowPrediction find() {
    CoupledState state = at(asked());
    if (state.none) {
      search();
      state = on_the_way();
    }
    if (state.none) refuse();
    try {
      return told(coupling_, state, gauge_);
    } catch (const InputError& error) {
      if (held_.empty()) search();
      why_ = {fmt::format("{} {}", error.where(), error.found()), error.mend()};
    }
    refuse();
  }

 private:
  double asked() const { return std::abs(asked_.si()); }
  double limit() const { return std::abs(held_.back().flow_rate.si()); }

  CoupledState at(double magnitude, const Array1* start = nullptr) const {
    const FlowRate flow_rate = FlowRate::from_si(std::copysign(magnitude, asked_.si()));
    return coupling_.solve(flow_rate, outlet_(flow_rate), start);
  }

  /// Follows the states up from the scale of the channel, by steps that halve where there is none
  /// and grow where there is: the limit does not depend on what was asked.
  void search() {
    constexpr double kResolved = 1e-3;  // of the flow rate
    constexpr int kMostHalvings = 20, kMostSteps = 200;
    double low = coupling_.scale().si();
    CoupledState state = at(low);
    for (int k = 0; state.none && k < kMostHalvings; ++k) state = at(low *= 0.5);
    why_ = state.none.value_or(NoState{});
    if (state.none) return;
    held_.push_back(std::move(state));
    double step = 1.0;
    for (int k = 0; step > kResolved && k < kMostSteps; ++k) {
      CoupledState next = at(limit() * (1.0 + step), &held_.back().pressure);
      step = next.none ? 0.5 * step : std::min(1.0, 1.5 * step);
      if (next.none) {
        why_ = *next.none;
      } else {
        held_.push_back(std::move(next));
      }
    }
    if (why_.settled) return;
    why_ = coupling_.on_the_edge(held_.back()).value_or(why_);
  }

  /// The state asked for from the nearest one below it.
  CoupledState on_the_way() const {
    const CoupledState* nearest = nullptr;
    for (const CoupledState& state : held_) {
      if (std::abs(state.flow_rate.si()) <= asked()) nearest = &state;
    }
    return at(asked(), nearest != nullptr ? &nearest->pressure : nullptr);
  }

  bool answered(double magnitude) const {
    const CoupledState state = at(magnitude);
    if (state.none) return false;
    try {
      told(coupling_, state, gauge_);
      return true;
    } catch (const InputError&) {
      return false;
    }
  }

  /// Two digits, in mL/min: the largest flow rate that is answered, and less than what was asked.
  double hint() const {
    constexpr int kMostSteps = 100;
    const double unit = FlowRate(1.0 * mL_per_min).si();
    double hint = two_digits(std::min(limit(), asked()) / unit);
    if (hint * unit >= asked()) hint = one_less(hint);
    for (int k = 0; k < kMostSteps && !answered(hint * unit); ++k) hint = one_less(hint);
    return hint;
  }

  [[noreturn]] void refuse() const {
    const auto advise = [&](const std::string& advice) {
      return why_.mend.empty() ? "Give " + advice : why_.mend + ", or give " + advice;
    };
    const std::string here = fmt::format("has no answer at {:g} mL/min", asked_.in(mL_per_min));
    if (held_.empty()) {
      throw InputError(kWhere, fmt::format("{}, nor at any lower flow rate: {}", here, why_.why),
                       advise("another outlet pressure"));
    }
    const std::string most = fmt::format("{:g} mL/min", std::copysign(hint(), asked_.si()));
    throw InputError(kWhere, fmt::format("{}: beyond {} {}", here, most, why_.why),
                     advise("at most " + most));
  }

  const FlowCoupling& coupling_;
  const OutletAt& outlet_;
  const inversion::GaugeErrors& gauge_;
  FlowRate asked_;
  std::vector<CoupledState> held_;  ///< by flow rate, the last one at the limit
  NoState why_;                     ///< what ends the answers there
};

}  // namespace

void PredictFlowOptions::validate() const {
  const auto refuse = [](const char* name, double value, const char* bound) {
    throw InputError(name, fmt::format("is {}", value), fmt::format("Give a number {}", bound));
  };
  if (!(largest_extrapolation >= 0.0)) {
    refuse("--largest-extrapolation", largest_extrapolation, "of 0 or more");
  }
  if (healing_length && !(*healing_length >= Length{})) {
    refuse("--healing-length", healing_length->si(), "of 0 or more");
  }
  if (!(tolerance > 0.0)) refuse("--tolerance", tolerance, "above 0");
  if (most_steps < 1) refuse("--most-steps", most_steps, "of 1 or more");
}

FlowPrediction predict_flow(const calibration::ConstitutiveCurves& curves, const FlowSetup& setup,
                            flow::FlowModel model, FlowRate flow_rate, const OutletAt& outlet,
                            const inversion::GaugeErrors& gauge,
                            const PredictFlowOptions& options) {
  options.validate();
  setup.channel.validate(kWhere);
  setup.fluid.validate(kWhere);
  const FlowCoupling coupling(curves, setup, model, options);
  return Answers(coupling, outlet, gauge, flow_rate).find();
}

FlowPrediction predict_flow(const calibration::ConstitutiveCurves& curves, const FlowSetup& setup,
                            flow::FlowModel model, FlowRate flow_rate, const Outlet& outlet,
                            const inversion::GaugeErrors& gauge,
                            const PredictFlowOptions& options) {
  return predict_flow(
      curves, setup, model, flow_rate, [&outlet](FlowRate) { return outlet; }, gauge, options);
}

}  // namespace manoscope::validation
