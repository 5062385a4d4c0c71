#include "manoscope/validation/predict_flow.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "manoscope/core/error.hpp"
#include "manoscope/flow/channel_resistance.hpp"
#include "manoscope/flow/section_flow.hpp"
#include "manoscope/validation/wall_answer.hpp"

namespace manoscope::validation {
namespace {

constexpr const char* kWhere = "predicted flow";
constexpr double kMarched = 2e-5;  // of p: far below the error of any march
constexpr int kMostMarches = 20;   // each is some ten times nearer

bool marches(flow::FlowModel model) {
  return model == flow::FlowModel::plane_march || model == flow::FlowModel::section_march;
}
bool has_inertia(flow::FlowModel model) {
  return model != flow::FlowModel::paper && model != flow::FlowModel::creeping;
}

/// G of P = G p, P - L^2 P'' = p with P' = 0 at both ends: linear elements, lumped.
Matrix spread_matrix(const Array1& x, Length healing_length) {
  const Index n = x.size();
  const double square = healing_length.si() * healing_length.si();
  if (!(square > 0.0)) return Matrix::Identity(n, n);
  Matrix system = Matrix::Zero(n, n), mass = Matrix::Zero(n, n);
  for (Index i = 0; i + 1 < n; ++i) {
    const double step = x[i + 1] - x[i];
    for (const Index end : {i, i + 1}) {
      mass(end, end) += 0.5 * step;
      system(end, end) += 0.5 * step + square / step;
    }
    system(i, i + 1) -= square / step;
    system(i + 1, i) -= square / step;
  }
  return system.partialPivLu().solve(mass);
}

class Coupling {
 public:
  Coupling(const calibration::ConstitutiveCurves& curves, const FlowSetup& setup,
           flow::FlowModel model, FlowRate flow_rate, const Outlet& outlet,
           const PredictFlowOptions& options)
      : wall_(curves, setup.channel.length, options.largest_extrapolation),
        setup_(setup),
        model_(model),
        flow_rate_(flow_rate),
        outlet_(outlet),
        options_(options) {
    if (!setup_.tables) {
      setup_ =
          with_tables(setup_, Length::from_si(wall_.least()), Length::from_si(wall_.greatest()));
    }
    const Length width = setup_.channel.width;
    spread_ =
        spread_matrix(wall_.x(), options.healing_length.value_or(width / (2.0 * std::numbers::pi)));
  }

  FlowPrediction solve(const inversion::GaugeErrors& gauge) {
    FlowPrediction result;
    result.model = model_;
    result.flow_rate = flow_rate_;
    result.x = wall_.x();
    result.station = wall_.station();
    Array1 p = start();
    correction_ = Array1::Zero(wall_.size());
    settle(p, result.steps);
    if (marches(model_)) march_on(p, result.steps);
    refuse_choking(p);
    refuse_extrapolation(p);
    finish(result, p, gauge);
    return result;
  }

 private:
  /// What a march adds to `momentum` changes little with the state: it is taken as it was at the
  /// last state, until that state meets the march itself.
  void march_on(Array1& p, int& steps) {
    for (int k = 0; k < kMostMarches; ++k) {
      const flow::FlowCase state = flow(p);
      const Array1 marched = flow::pressure_along(model_, state, *setup_.tables).pressure;
      if (!marched.isFinite().all()) unsettled(p);
      if ((marched - p).abs().maxCoeff() <= kMarched * std::max(1.0, p.abs().maxCoeff())) return;
      correction_ =
          marched - flow::pressure_along(flow::FlowModel::momentum, state, *setup_.tables).pressure;
      settle(p, steps);
    }
    unsettled(p);
  }

  /// Newton's method on p = m(zeta(p)) + correction.
  void settle(Array1& p, int& steps) const {
    const Index n = wall_.size();
    Array1 residual = p - modelled(p);
    for (int own = 1;; ++own) {
      ++steps;
      if (own > options_.most_steps || !residual.isFinite().all()) unsettled(p);
      const Matrix jacobian = Matrix::Identity(n, n) - coupling(p);
      const Array1 step = -jacobian.partialPivLu().solve(residual.matrix()).array();
      const double scale = std::max(1.0, p.abs().maxCoeff());
      if (!step.isFinite().all()) unsettled(p);
      // Halve while the residual grows, so that no step leaps over the bend of the curves.
      double share = 1.0;
      Array1 next = p + step, after = next - modelled(next);
      while (share > 1e-3 && !(after.matrix().norm() <= residual.matrix().norm())) {
        share *= 0.5;
        next = p + share * step;
        after = next - modelled(next);
      }
      p = next;
      residual = after;
      if (share == 1.0 && step.abs().maxCoeff() <= options_.tolerance * scale) return;
    }
  }

  /// What the wall answers to, P.
  Array1 felt(const Array1& p) const { return (spread_ * p.matrix()).array(); }
  flow::FlowCase flow(const Array1& p) const {
    flow::FlowCase one = flow_case(setup_, flow_rate_, wall_.line(felt(p)));
    one.outlet_pressure = outlet_.pressure;
    return one;
  }
  /// The model whose derivatives are cheap: its own, or what stands in for a march.
  flow::FlowModel local() const { return marches(model_) ? flow::FlowModel::momentum : model_; }
  Array1 modelled(const Array1& p) const {
    return flow::pressure_along(local(), flow(p), *setup_.tables).pressure + correction_;
  }
  Array1 slopes(const Array1& p) const {
    const Array1 at = felt(p);
    Array1 result(p.size());
    for (Index i = 0; i < p.size(); ++i) result[i] = wall_.slope(i, at[i]);
    return result;
  }
  /// dm/dzeta dzeta/dp.
  Matrix coupling(const Array1& p) const {
    const Matrix by_zeta = flow::flow_sensitivity(local(), flow(p), *setup_.tables).by_zeta;
    return by_zeta * slopes(p).matrix().asDiagonal() * spread_;
  }
  /// A straight fall from the pressure before the undeflected wall, inside the calibrated range.
  Array1 start() const {
    const double out = outlet_.pressure.si();
    const Array1 flat =
        flow::pressure_along(flow::FlowModel::paper, flow(Array1::Constant(wall_.size(), out)))
            .pressure;
    double highest = flat[0];
    for (Index i = 0; i < wall_.size(); ++i) highest = std::min(highest, wall_.highest(i));
    return out + std::max(0.0, highest - out) * (1.0 - wall_.x() / setup_.channel.length.si());
  }

  Array1 speed_index(const Array1& p) const {
    Array1 result = Array1::Zero(p.size());
    if (!has_inertia(model_)) return result;
    const double width = setup_.channel.width.si();
    const flow::SectionFamily& family = setup_.tables->family;
    const double span = setup_.tables->step.si();
    const Array1 at = felt(p), slope = slopes(p);
    for (Index i = 0; i < p.size(); ++i) {
      const double zeta = wall_.zeta(i, at[i]);
      const auto beta = [&](double deflection) {
        return family.at(Length::from_si(deflection)).momentum_factor;
      };
      result[i] = flow::speed_index(
          beta(zeta), (beta(zeta + span) - beta(zeta - span)) / (2.0 * span * width), setup_.fluid,
          flow_rate_, width * (setup_.channel.height.si() + zeta), width * slope[i]);
    }
    return result;
  }
  /// Means of the speed index over stretches as long as the wall's own response, w/pi: what is
  /// shorter the wall does not follow.
  Array1 spread_index(const Array1& p) const {
    const Array1 local = speed_index(p);
    const Array1& x = wall_.x();
    const double half = 0.5 * setup_.channel.width.si() / std::numbers::pi;
    Array1 result(p.size());
    for (Index i = 0; i < p.size(); ++i) {
      const double from = std::max(0.0, x[i] - half), to = std::min(x[p.size() - 1], x[i] + half);
      const Array1 weights = flow::interval_weights(x, Length::from_si(from), Length::from_si(to));
      result[i] = (weights * local).sum() / (to - from);
    }
    return result;
  }
  void refuse_choking(const Array1& p) const {
    if (!has_inertia(model_)) return;
    Index place = 0;
    const double greatest = spread_index(p).maxCoeff(&place);
    if (greatest < 1.0) return;
    throw InputError(
        kWhere,
        fmt::format("the flow chokes about x = {:.4g} mm: its speed index S^2 is {:.3g} at {:.4g} "
                    "mL/min",
                    wall_.x()[place] * 1e3, greatest, flow_rate_.in(mL_per_min)),
        fmt::format("Such a state cannot be steady. Check the curves and the units, or give less "
                    "than about {:.4g} mL/min",
                    flow_rate_.in(mL_per_min) / std::sqrt(greatest)));
  }
  void refuse_extrapolation(const Array1& p) const {
    const Array1 at = felt(p);
    for (Index i = 0; i < p.size(); ++i) {
      if (wall_.beyond(i, at[i]) == 0.0) continue;
      const bool above = at[i] > wall_.highest(i);
      throw InputError(
          kWhere,
          fmt::format("at {:.4g} mL/min the pressure at x = {:.4g} mm would be {:.4g} kPa, where "
                      "the calibration ends at {:.4g} kPa",
                      flow_rate_.in(mL_per_min), wall_.x()[i] * 1e3, at[i] * 1e-3,
                      (above ? wall_.highest(i) : wall_.lowest(i)) * 1e-3),
          above
              ? fmt::format("Calibrate to a higher pressure, or give less than about {:.3g} mL/min",
                            flow_rate_.in(mL_per_min)*wall_.highest(i) / at[i])
              : std::string("Calibrate to a lower pressure, or give a higher outlet pressure"));
    }
  }
  [[noreturn]] void unsettled(const Array1& p) const {
    if (p.isFinite().all()) {
      refuse_choking(p);
      refuse_extrapolation(p);
    }
    throw InputError(kWhere,
                     fmt::format("no steady state was found at {:.4g} mL/min by the model \"{}\"",
                                 flow_rate_.in(mL_per_min), flow::flow_model_info(model_).name),
                     "Give a lower flow rate, or another flow model");
  }

  void finish(FlowPrediction& result, const Array1& p, const inversion::GaugeErrors& gauge) const {
    const Index n = p.size();
    result.pressure = p;
    result.zeta = flow(p).zeta;
    result.speed_index = speed_index(p);
    const ModelledRun run = modelled_run(model_, setup_, flow_rate_, wall_.line(felt(p)));
    result.error = run.error;
    set_flags(result, p, run.sensitivity.modelled);

    const Array1 s = slopes(p);
    const Matrix jacobian =
        Matrix::Identity(n, n) - run.sensitivity.by_zeta * s.matrix().asDiagonal() * spread_;
    const Eigen::PartialPivLU<Matrix> solver(jacobian);
    result.uncertainty.independent = result.zeta_uncertainty.independent = Array1::Zero(n);
    const auto add = [&](const std::string& variable, const std::string& source,
                         const Array1& of_zeta, const Array1& of_model) {
      if ((of_zeta == 0.0).all() && (of_model == 0.0).all()) return;
      const Array1 effect =
          solver.solve(run.sensitivity.by_zeta * of_zeta.matrix() + of_model.matrix()).array();
      result.uncertainty.modes.push_back({variable, source, effect});
      result.zeta_uncertainty.modes.push_back({variable, source, s * felt(effect) + of_zeta});
    };
    const Array1 none = Array1::Zero(n);
    const Uncertainty errors = wall_.errors(felt(p), gauge);
    for (const ErrorMode& mode : errors.modes) add(mode.variable, mode.source, mode.effect, none);
    for (Index i = 0; i < n; ++i) {
      Array1 one = none;
      one[i] = errors.independent[i];
      add(fmt::format("noise of the curves at station {}",
                      wall_.station()[static_cast<std::size_t>(i)]),
          "pixel noise", one, none);
    }
    const FlowUncertainty& u = setup_.uncertainty;
    const Array1 fall = run.pressure();  // p - p_out
    add("channel height", "channel height", none, u.height.si() * run.sensitivity.by_height);
    add("viscosity", "viscosity", none,
        (u.viscosity / setup_.fluid.viscosity) * run.sensitivity.by_viscosity);
    add("flow rate", "flow rate", none, u.flow_rate * run.sensitivity.by_flow_rate);
    add("outlet pressure", "outlet pressure", none, Array1::Constant(n, outlet_.uncertainty.si()));
    const std::string name(flow::flow_model_info(model_).name);
    add("flow model " + name, "flow model", none, run.error.standard() * fall);
    if (fall[0] != 0.0) {
      const Array1 share = fall / fall[0];
      add("flow model " + name + ", bend", "flow model", none,
          run.error.standard() * fall[0] * 4.0 * share * (1.0 - share));
    }
    add("inlet profile", "inlet profile", none, run.inlet_effect);
    result.drop.value = p[0] - p[n - 1];
    for (const ErrorMode& mode : result.uncertainty.modes) {
      result.drop.terms.push_back(
          {mode.variable, mode.source, mode.effect[0] - mode.effect[n - 1]});
    }
  }

  void set_flags(FlowPrediction& result, const Array1& p,
                 const flow::ModelledPressure& modelled) const {
    result.flags = Flags1::Zero(p.size());
    const Array1 at = felt(p), slope = slopes(p);
    bool doubt = false;
    for (Index i = p.size(); i-- > 0;) {
      FlagBits& flags = result.flags[i];
      if (doubt) flags |= PredictionFlag::downstream_doubt;
      if (wall_.is_outside(i, at[i])) flags |= PredictionFlag::out_of_calibration;
      if (slope[i] < 0.0) flags |= PredictionFlag::falling_curve;
      doubt = doubt || flags != 0;
      if (modelled.flags[i] != 0) flags |= PredictionFlag::separated;
      if (result.speed_index[i] >= 1.0) flags |= PredictionFlag::nearly_choked;
    }
  }

  CurvedWall wall_;
  FlowSetup setup_;
  flow::FlowModel model_;
  FlowRate flow_rate_;
  Outlet outlet_;
  PredictFlowOptions options_;
  Matrix spread_;      ///< from p to what the wall answers to
  Array1 correction_;  ///< Pa, of a march to `momentum`
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
                            flow::FlowModel model, FlowRate flow_rate, const Outlet& outlet,
                            const inversion::GaugeErrors& gauge,
                            const PredictFlowOptions& options) {
  options.validate();
  setup.channel.validate(kWhere);
  setup.fluid.validate(kWhere);
  return Coupling(curves, setup, model, flow_rate, outlet, options).solve(gauge);
}

}  // namespace manoscope::validation
