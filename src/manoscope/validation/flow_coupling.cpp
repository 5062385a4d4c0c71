#include "manoscope/validation/flow_coupling.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "manoscope/core/error.hpp"
#include "manoscope/flow/channel_resistance.hpp"
#include "manoscope/flow/section_flow.hpp"

namespace manoscope::validation {
namespace {

constexpr double kMarched = 2e-5;  // of p: far below the error of any march
constexpr int kMostMarches = 20;   // each is some ten times nearer
constexpr int kMostStalled = 8;    // steps in a row that lead nowhere

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

}  // namespace

FlowCoupling::FlowCoupling(const calibration::ConstitutiveCurves& curves, const FlowSetup& setup,
                           flow::FlowModel model, const PredictFlowOptions& options)
    : wall_(curves, setup.channel.length, options.largest_extrapolation),
      setup_(setup),
      model_(model),
      options_(options) {
  if (!setup_.tables) {
    setup_ = with_tables(setup_, Length::from_si(wall_.least()), Length::from_si(wall_.greatest()));
  }
  const Length width = setup_.channel.width;
  spread_ =
      spread_matrix(wall_.x(), options.healing_length.value_or(width / (2.0 * std::numbers::pi)));
}

CoupledState FlowCoupling::solve(FlowRate flow_rate, const Outlet& outlet,
                                 const Array1* start_from) const {
  CoupledState state{flow_rate, outlet, {}, Array1::Zero(wall_.size()), 0, std::nullopt};
  const std::string model(flow::flow_model_info(model_).name);
  try {
    state.pressure = start_from != nullptr ? *start_from : start(state);
    if (!settle(state)) {
      state.none = NoState{fmt::format("the model \"{}\" finds no steady state", model), "", false};
    } else if (marches(model_) && !march_on(state)) {
      state.none = NoState{fmt::format("the {} breaks down", model), "Take another flow model"};
    }
  } catch (const InputError& error) {
    state.none = NoState{fmt::format("{}: {}", error.where(), error.found()), error.mend(), false};
  }
  // Only a state that has settled can be judged.
  if (!state.none) state.none = choking(state, 1.0);
  if (!state.none) state.none = extrapolation(state);
  return state;
}

/// What a march adds to `momentum` changes little with the state: it is taken as it was at the
/// last state, until that state meets the march itself.
bool FlowCoupling::march_on(CoupledState& state) const {
  for (int k = 0; k < kMostMarches; ++k) {
    const flow::FlowCase at = flow(state, state.pressure);
    const Array1 marched = flow::pressure_along(model_, at, *setup_.tables).pressure;
    if (!marched.isFinite().all()) return false;
    const double scale = std::max(1.0, state.pressure.abs().maxCoeff());
    if ((marched - state.pressure).abs().maxCoeff() <= kMarched * scale) return true;
    state.correction =
        marched - flow::pressure_along(flow::FlowModel::momentum, at, *setup_.tables).pressure;
    if (!settle(state)) return false;
  }
  return false;
}

/// Newton's method on p = m(zeta(p)) + correction; whether it has settled.
bool FlowCoupling::settle(CoupledState& state) const {
  const Index n = wall_.size();
  Array1& p = state.pressure;
  Array1 residual = p - modelled(state, p);
  int stalled = 0;
  for (int own = 1; stalled < kMostStalled; ++own) {
    ++state.steps;
    if (own > options_.most_steps || !residual.isFinite().all()) return false;
    const Matrix jacobian = Matrix::Identity(n, n) - coupling(state);
    const Array1 step = -jacobian.partialPivLu().solve(residual.matrix()).array();
    const double scale = std::max(1.0, p.abs().maxCoeff());
    if (!step.isFinite().all()) return false;
    // Halve while the residual grows, so that no step leaps over the bend of the curves.
    constexpr double kLeastShare = 1e-3;
    double share = 1.0;
    Array1 next = p + step, after = next - modelled(state, next);
    while (share > kLeastShare && !(after.matrix().norm() <= residual.matrix().norm())) {
      share *= 0.5;
      next = p + share * step;
      after = next - modelled(state, next);
    }
    p = next;
    residual = after;
    if (share == 1.0 && step.abs().maxCoeff() <= options_.tolerance * scale) return true;
    stalled = share > kLeastShare ? 0 : stalled + 1;
  }
  return false;
}

/// A straight fall from the pressure before the undeflected wall, inside the calibrated range.
Array1 FlowCoupling::start(const CoupledState& state) const {
  const double out = state.outlet.pressure.si();
  const Array1 flat =
      flow::pressure_along(flow::FlowModel::paper, flow(state, Array1::Constant(wall_.size(), out)))
          .pressure;
  double highest = flat[0];
  for (Index i = 0; i < wall_.size(); ++i) highest = std::min(highest, wall_.highest(i));
  return out + std::max(0.0, highest - out) * (1.0 - wall_.x() / setup_.channel.length.si());
}

FlowRate FlowCoupling::scale() const {
  const FlowRate unit = 1.0 * mL_per_min;
  const CoupledState rest{unit, {}, {}, Array1::Zero(wall_.size()), 0, std::nullopt};
  const double drop =
      flow::pressure_along(flow::FlowModel::paper, flow(rest, Array1::Zero(wall_.size())))
          .pressure[0];
  double range = 0.0;
  for (Index i = 0; i < wall_.size(); ++i) {
    if (!std::isfinite(wall_.highest(i))) continue;
    range = std::max({range, std::abs(wall_.highest(i)), std::abs(wall_.lowest(i))});
  }
  return unit * (range / drop);
}

flow::FlowCase FlowCoupling::flow(const CoupledState& state, const Array1& p) const {
  flow::FlowCase one = flow_case(setup_, state.flow_rate, wall_.line(felt(p)));
  one.outlet_pressure = state.outlet.pressure;
  return one;
}

/// The model whose derivatives are cheap: its own, or what stands in for a march.
flow::FlowModel FlowCoupling::local() const {
  return marches(model_) ? flow::FlowModel::momentum : model_;
}

Array1 FlowCoupling::modelled(const CoupledState& state, const Array1& p) const {
  return flow::pressure_along(local(), flow(state, p), *setup_.tables).pressure + state.correction;
}

Array1 FlowCoupling::slopes(const Array1& p) const {
  const Array1 at = felt(p);
  Array1 result(p.size());
  for (Index i = 0; i < p.size(); ++i) result[i] = wall_.slope(i, at[i]);
  return result;
}

/// dm/dzeta dzeta/dp.
Matrix FlowCoupling::coupling(const CoupledState& state) const {
  const Matrix by_zeta =
      flow::flow_sensitivity(local(), flow(state, state.pressure), *setup_.tables).by_zeta;
  return by_zeta * slopes(state.pressure).matrix().asDiagonal() * spread_;
}

Array1 FlowCoupling::speed_index(const CoupledState& state) const {
  const Array1& p = state.pressure;
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
        state.flow_rate, width * (setup_.channel.height.si() + zeta), width * slope[i]);
  }
  return result;
}

/// Means of the speed index over stretches as long as the wall's own response, w/pi: what is
/// shorter the wall does not follow.
Array1 FlowCoupling::spread_index(const CoupledState& state) const {
  const Array1 local = speed_index(state);
  const Array1& x = wall_.x();
  const Index n = x.size();
  const double half = 0.5 * setup_.channel.width.si() / std::numbers::pi;
  Array1 result(n);
  for (Index i = 0; i < n; ++i) {
    const double from = std::max(0.0, x[i] - half), to = std::min(x[n - 1], x[i] + half);
    const Array1 weights = flow::interval_weights(x, Length::from_si(from), Length::from_si(to));
    result[i] = (weights * local).sum() / (to - from);
  }
  return result;
}

std::optional<NoState> FlowCoupling::choking(const CoupledState& state, double from) const {
  if (!has_inertia(model_)) return std::nullopt;
  Index place = 0;
  if (spread_index(state).maxCoeff(&place) < from) return std::nullopt;
  return NoState{fmt::format("the flow chokes about x = {:.4g} mm, where it outruns the waves of "
                             "the wall (speed index S^2 = 1)",
                             wall_.x()[place] * 1e3),
                 ""};
}

NoState FlowCoupling::left_range(Index station, double pressure) const {
  const bool above = pressure > wall_.highest(station);
  return {
      fmt::format("the pressure at x = {:.4g} mm lies too far outside the calibration, which {} "
                  "at {:.4g} kPa",
                  wall_.x()[station] * 1e3, above ? "ends" : "begins",
                  (above ? wall_.highest(station) : wall_.lowest(station)) * 1e-3),
      above ? "Calibrate to a higher pressure"
            : "Calibrate to a lower pressure or give a higher outlet pressure"};
}

std::optional<NoState> FlowCoupling::extrapolation(const CoupledState& state) const {
  const Array1 at = felt(state.pressure);
  for (Index i = 0; i < at.size(); ++i) {
    if (wall_.beyond(i, at[i]) != 0.0) return left_range(i, at[i]);
  }
  return std::nullopt;
}

std::optional<NoState> FlowCoupling::on_the_edge(const CoupledState& state) const {
  constexpr double kNear = 0.8;  // S^2 of a state that a percent of flow rate more may end
  if (auto chokes = choking(state, kNear)) return chokes;
  const Array1 at = felt(state.pressure);
  for (Index i = 0; i < at.size(); ++i) {
    if (wall_.is_outside(i, at[i])) return left_range(i, at[i]);
  }
  return std::nullopt;
}

}  // namespace manoscope::validation
