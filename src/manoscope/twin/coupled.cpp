#include "manoscope/twin/coupled.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "manoscope/core/error.hpp"
#include "manoscope/flow/duct_resistance.hpp"
#include "manoscope/wall/clamped_wall.hpp"

namespace manoscope::twin {
namespace {

constexpr const char* kWhere = "coupled flow";
constexpr const char* kMendChoking =
    "Lower the flow rate, raise the outlet pressure, or take a stiffer wall: at S^2 = 1 the flow "
    "is "
    "as fast as the waves of the wall, and no steady flow exists beyond";
/// Largest relative change of the drop between n/2 and n steps; the error of n steps is a
/// fifteenth.
constexpr double kMostChange = 1e-3;
constexpr double kSettled = 1e-9;      // largest residual of p, of the drop
constexpr int kMostIterations = 20;    // of Newton's method at one flow rate
constexpr int kMostHalvings = 6;       // of one Newton step
constexpr double kNearlyChoked = 0.7;  // S^2 of the last flow found where no further one is
constexpr int kAcross = 15;  // points across at which contact with the floor is looked for
constexpr double kShortest = 1.0 / 64;  // of the way from the start to the flow rate asked for
/// The wall is loaded at so many even cells, p between the nodes by cubics: what p of the paper's
/// channels bends within one is below 1 mPa.
constexpr Index kLoadCells = 3840;

/// Nodes stand ten times closer at the ends than on average: with inertia, p follows the section
/// where the clamped wall rises within tens of micrometres.
constexpr double kGrading = 0.9;

/// Integral over s from each of n + 1 even nodes in [0, 1] to the last, as a matrix on the nodal
/// values: cubics through four nodes, fourth order.
Matrix integral_to_end(Index n) {
  const double step = 1.0 / static_cast<double>(n);
  Matrix integral = Matrix::Zero(n + 1, n + 1);
  for (Index i = n - 1; i >= 0; --i) {
    integral.row(i) = integral.row(i + 1);
    const auto add = [&](Index j, double weight) { integral(i, j) += step / 24.0 * weight; };
    if (i == 0) {
      add(0, 9.0), add(1, 19.0), add(2, -5.0), add(3, 1.0);
    } else if (i == n - 1) {
      add(n, 9.0), add(n - 1, 19.0), add(n - 2, -5.0), add(n - 3, 1.0);
    } else {
      add(i - 1, -1.0), add(i, 13.0), add(i + 1, 13.0), add(i + 2, -1.0);
    }
  }
  return integral;
}

/// S^2 along a channel: the largest and where it is, m.
struct Choking {
  double square = 0.0, at = 0.0;
};

/// The equation of p at the nodes.
class MomentumEquation {
 public:
  MomentumEquation(const flow::Channel& channel, const flow::Fluid& fluid,
                   const CoupledOptions& options)
      : channel_(channel),
        fluid_(fluid),
        formula_(options.exact_duct ? flow::DuctFormula::series : flow::DuctFormula::wide_duct),
        x_(ChannelCurve::nodes(channel.length, options.steps, kGrading)),
        integral_(
            integral_to_end(options.steps) *
            ChannelCurve::stretch(channel.length, options.steps, kGrading).matrix().asDiagonal()),
        flux_(options.momentum_factor * fluid.density.si()) {}

  const Array1& x() const { return x_; }

  /// What p should be where the wall stands at zeta: (n).
  Array1 pressure(double flow_rate, double outlet, const Array1& zeta) const {
    const Array1 gap = channel_.height.si() + zeta, area = channel_.width.si() * gap;
    const Array1 friction =
        flow_rate * flow::duct_resistance(fluid_.viscosity, channel_.width, gap, formula_);
    const Array1 head = 0.5 * flux_ * flow_rate * flow_rate / area.square();
    return outlet + (integral_ * friction.matrix()).array() + head(head.size() - 1) - head;
  }
  /// Its derivative: (n, n), Pa/m.
  Matrix slope(double flow_rate, const Array1& zeta) const {
    const Array1 gap = channel_.height.si() + zeta, area = channel_.width.si() * gap;
    const Array1 friction =
        flow_rate * flow::duct_resistance_slope(fluid_.viscosity, channel_.width, gap, formula_);
    const Array1 head =
        flux_ * flow_rate * flow_rate * channel_.width.si() / (area.square() * area);
    const Index last = head.size() - 1;
    Matrix slope = integral_ * friction.matrix().asDiagonal();
    slope.diagonal() += head.matrix();
    slope.col(last).array() -= head(last);
    return slope;
  }
  Choking choking(double flow_rate, const Array1& zeta, const Array1& compliance) const {
    const Array1 area = channel_.width.si() * (channel_.height.si() + zeta);
    const Array1 square =
        flux_ * flow_rate * flow_rate * channel_.width.si() * compliance / (area.square() * area);
    Index at = 0;
    const double largest = square.maxCoeff(&at);
    return {largest, x_(at)};
  }

 private:
  flow::Channel channel_;
  flow::Fluid fluid_;
  flow::DuctFormula formula_;
  Array1 x_;
  Matrix integral_;
  double flux_;  ///< beta rho, kg/m^3
};

/// A place on the wall, m.
struct Place {
  double x, z;
};

/// Where the wall touches the floor; none where it is clear of it. Looked for at the stations, each
/// at kAcross even points from side to side: a folded wall hangs lowest off its centre line.
std::optional<Place> contact(const flow::Channel& channel, const WallAtRest& wall,
                             const Array1& x) {
  const double width = channel.width.si();
  for (Index i = 0; i < x.size(); ++i) {
    for (int k = 1; k <= kAcross; ++k) {
      const double z = (static_cast<double>(k) / (kAcross + 1) - 0.5) * width;
      if (!(channel.height.si() + wall.shape(x(i), z) > 0.0)) return Place{x(i), z};
    }
  }
  return std::nullopt;
}

[[noreturn]] void refuse_contact(const Place& at, double p, FlowRate flow_rate) {
  throw InputError(
      kWhere,
      fmt::format("the wall touches the floor at x = {:.4g} mm, z = {:.3g} mm, under {:.4g} Pa, "
                  "{:.3g} mL/min",
                  at.x * 1e3, at.z * 1e3, p, flow_rate.in(mL_per_min)),
      "Raise the channel height or the outlet pressure, or lower the preload of the wall");
}

[[noreturn]] void refuse_rise(const WallModel& wall, double p, FlowRate flow_rate) {
  throw InputError(
      kWhere,
      fmt::format("{:.4g} Pa at {:.3g} mL/min lift the wall beyond its theory, which ends near "
                  "{:.4g} Pa, at a crest of {:g} of half its width",
                  p, flow_rate.in(mL_per_min), wall.largest_pressure.si(), wall::kLargestRise),
      "Lower the pressure or the flow rate, or take a stiffer, thicker or narrower wall");
}

/// The wall under p at the nodes.
WallAtRest load_wall(const WallModel& wall, const WallAtRest& from, const ChannelCurve& pressure) {
  const Array1 x = Array1::LinSpaced(kLoadCells + 1, 0.0, pressure.length().si());
  return wall.load(from, x, pressure(x));
}

/// A flow that Newton's method has in hand.
struct Iterate {
  Array1 pressure;
  WallAtRest wall;
  Array1 zeta, residual;
};

class Solver {
 public:
  Solver(const flow::Channel& channel, const flow::Fluid& fluid, const WallModel& wall,
         const CoupledOptions& options, const Monitor& monitor)
      : channel_(channel), wall_(wall), equation_(channel, fluid, options), monitor_(monitor) {}

  /// The flow near a start; none where Newton's method does not reach one.
  std::optional<Iterate> solve(double flow_rate, double outlet, const Array1& pressure,
                               const WallAtRest& from) {
    std::optional<Iterate> now = at(pressure, from, flow_rate, outlet);
    for (int n = 0; now && n < kMostIterations; ++n) {
      monitor_.checkpoint();
      const double largest = now->residual.abs().maxCoeff();
      const double drop = std::abs(now->pressure(0) - outlet);
      if (largest <= kSettled * drop || largest == 0.0) return now;
      const Matrix influence = now->wall.influence(equation_.x());
      const Index size = influence.rows();
      const Matrix tangent =
          Matrix::Identity(size, size) - equation_.slope(flow_rate, now->zeta) * influence;
      const Array1 step = -tangent.partialPivLu().solve(now->residual.matrix()).array();
      if (!step.allFinite()) return std::nullopt;
      double share = 1.0;
      std::optional<Iterate> next;
      for (int halving = 0; halving <= kMostHalvings; ++halving, share *= 0.5) {
        next = at(now->pressure + share * step, now->wall, flow_rate, outlet);
        if (next && next->residual.abs().maxCoeff() < largest) break;
        next.reset();
      }
      // Round-off of the wall's own solution ends the descent a little above kSettled.
      if (!next && largest <= 100.0 * kSettled * drop) return now;
      now = std::move(next);
    }
    return std::nullopt;
  }

  CoupledFlow finished(double flow_rate, Iterate flow) const {
    const Choking choking = choking_of(flow_rate, flow);
    if (choking.square >= 1.0) refuse_choking(flow_rate, choking);
    return {FlowRate::from_si(flow_rate), ChannelCurve(channel_.length, flow.pressure, kGrading),
            ChannelCurve(channel_.length, flow.zeta, kGrading), std::move(flow.wall),
            std::sqrt(std::max(choking.square, 0.0))};
  }

  /// Says why there is no flow beyond the last one that was found.
  [[noreturn]] void refuse(double flow_rate, double outlet, double last_flow_rate,
                           const std::optional<Iterate>& last) const {
    if (contact_) refuse_contact(*contact_, outlet, FlowRate::from_si(flow_rate));
    if (beyond_) refuse_rise(wall_, *beyond_, FlowRate::from_si(flow_rate));
    const Choking choking = last ? choking_of(last_flow_rate, *last) : Choking{};
    if (choking.square >= kNearlyChoked) {
      throw InputError(
          kWhere,
          fmt::format(
              "no flow is found at {:.4g} mL/min, and the last one found, at {:.4g} mL/min, "
              "is close to choking: S^2 = {:.3g} at x = {:.4g} mm",
              FlowRate::from_si(flow_rate).in(mL_per_min),
              FlowRate::from_si(last_flow_rate).in(mL_per_min), choking.square, choking.at * 1e3),
          kMendChoking);
    }
    throw InputError(kWhere,
                     fmt::format("flow and wall find no common state at {:.4g} mL/min; at {:.4g} "
                                 "mL/min S^2 was {:.2g}",
                                 FlowRate::from_si(flow_rate).in(mL_per_min),
                                 FlowRate::from_si(last_flow_rate).in(mL_per_min), choking.square),
                     "Raise the number of steps, widen a channel that is nearly closed, or lower "
                     "the flow rate");
  }

  const Array1& x() const { return equation_.x(); }

 private:
  std::optional<Iterate> at(const Array1& pressure, const WallAtRest& from, double flow_rate,
                            double outlet) {
    Iterate made;
    made.pressure = pressure;
    contact_ = std::nullopt;
    beyond_ = std::nullopt;
    const double largest = pressure.abs().maxCoeff();
    if (largest > wall_.largest_pressure.si()) {
      beyond_ = largest;  // no need to see what a law says that does not hold there
      return std::nullopt;
    }
    try {
      made.wall = load_wall(wall_, from, ChannelCurve(channel_.length, pressure, kGrading));
    } catch (const InputError&) {
      return std::nullopt;  // a step too wide: the wall has no state there
    }
    contact_ = contact(channel_, made.wall, equation_.x());
    if (contact_) return std::nullopt;
    made.zeta = made.wall.deflection(equation_.x());
    made.residual = pressure - equation_.pressure(flow_rate, outlet, made.zeta);
    return made;
  }

  Choking choking_of(double flow_rate, const Iterate& flow) const {
    return equation_.choking(flow_rate, flow.zeta, flow.wall.compliance(equation_.x()));
  }

  [[noreturn]] static void refuse_choking(double flow_rate, const Choking& choking) {
    throw InputError(
        kWhere,
        fmt::format("the channel chokes: at {:.4g} mL/min S^2 reaches {:.3g} at x = {:.4g} mm",
                    FlowRate::from_si(flow_rate).in(mL_per_min), choking.square, choking.at * 1e3),
        kMendChoking);
  }

  flow::Channel channel_;
  const WallModel& wall_;
  MomentumEquation equation_;
  const Monitor& monitor_;
  // Of the last wall that was tried:
  std::optional<Place> contact_;  ///< where it touched the floor
  std::optional<double> beyond_;  ///< pressure under which its law does not hold, Pa
};

void check_inputs(const flow::Channel& channel, const WallModel& wall, FlowRate flow_rate,
                  Pressure outlet_pressure) {
  channel.validate(kWhere);
  if (!(std::abs(wall.length / channel.length - 1.0) <= 1e-12)) {
    throw InputError(kWhere,
                     fmt::format("the wall is {:g} mm long, the channel {:g} mm",
                                 wall.length.in(mm), channel.length.in(mm)),
                     "Give both the same length");
  }
  if (!std::isfinite(flow_rate.si()) || !std::isfinite(outlet_pressure.si())) {
    throw InputError(kWhere, "flow rate or outlet pressure is not finite",
                     "Give values such as \"70 mL/min\" and \"300 Pa\"");
  }
}

/// Flow rate and outlet pressure go from those of the start to those asked for, in as few steps as
/// Newton's method allows.
CoupledFlow go_to(Solver& solver, const CoupledFlow& start, double flow_rate, double outlet) {
  const double flow_before = start.flow_rate.si(), outlet_before = start.outlet().si();
  Array1 pressure = start.pressure(solver.x());
  WallAtRest wall = start.wall;
  std::optional<Iterate> last;
  double reached = 0.0, step = 1.0;
  while (true) {
    const double share = std::min(1.0, reached + step);
    const double flow_there = flow_before + share * (flow_rate - flow_before);
    const double outlet_there = outlet_before + share * (outlet - outlet_before);
    const double raised = outlet_before + reached * (outlet - outlet_before);
    auto found = solver.solve(flow_there, outlet_there, pressure + (outlet_there - raised), wall);
    if (!found) {
      step *= 0.5;
      if (step < kShortest) {
        solver.refuse(flow_there, outlet_there, flow_before + reached * (flow_rate - flow_before),
                      last);
      }
      continue;
    }
    if (share >= 1.0) return solver.finished(flow_rate, *std::move(found));
    pressure = found->pressure;
    wall = found->wall;
    last = std::move(found);
    reached = share;
  }
}

}  // namespace

void CoupledOptions::validate() const {
  if (steps < 10 || steps > 2000 || steps % 2 != 0) {
    throw InputError(kWhere, fmt::format("steps is {}", steps),
                     "Choose an even number from 10 to 2000");
  }
  if (!(momentum_factor >= 0.0 && momentum_factor <= 2.0)) {
    throw InputError(kWhere, fmt::format("momentum_factor is {:g}", momentum_factor),
                     "Choose 0 (creeping flow) or 1 (flat profile) to 2; a parabola has 1.2");
  }
}

CoupledFlow fill_channel(const flow::Channel& channel, const WallModel& wall,
                         const WallAtRest& from, Pressure pressure, const CoupledOptions& options) {
  options.validate();
  check_inputs(channel, wall, FlowRate{}, pressure);
  ChannelCurve curve(channel.length, Array1::Constant(options.steps + 1, pressure.si()), kGrading);
  const Array1 x = ChannelCurve::nodes(channel.length, options.steps, kGrading);
  if (std::max(pressure, -pressure) > wall.largest_pressure) {
    refuse_rise(wall, pressure.si(), FlowRate{});
  }
  WallAtRest filled = load_wall(wall, from, curve);
  if (const auto at = contact(channel, filled, x)) {
    refuse_contact(*at, pressure.si(), FlowRate{});
  }
  ChannelCurve deflection(channel.length, filled.deflection(x), kGrading);
  return {FlowRate{}, std::move(curve), std::move(deflection), std::move(filled), 0.0};
}

CoupledFlow solve_coupled(const flow::Channel& channel, const flow::Fluid& fluid,
                          const WallModel& wall, const CoupledFlow& start, FlowRate flow_rate,
                          Pressure outlet_pressure, const CoupledOptions& options,
                          const Monitor& monitor) {
  options.validate();
  fluid.validate(kWhere);
  check_inputs(channel, wall, flow_rate, outlet_pressure);
  const double q = flow_rate.si(), outlet = outlet_pressure.si();
  Solver solver(channel, fluid, wall, options, monitor);
  CoupledFlow flow = go_to(solver, start, q, outlet);
  CoupledOptions half = options;
  half.steps /= 2;
  Solver rough(channel, fluid, wall, half, monitor);
  const auto check = rough.solve(q, outlet, flow.pressure(rough.x()), flow.wall);
  const double drop = std::abs((flow.inlet() - flow.outlet()).si());
  const double change = check ? std::abs(flow.inlet().si() - check->pressure(0)) : drop;
  if (!(change <= kMostChange * drop)) {
    throw InputError(kWhere,
                     fmt::format("{} steps do not resolve the flow at {:.3g} mL/min: half of them "
                                 "move the drop of {:.4g} Pa by {:.3g} Pa",
                                 options.steps, flow_rate.in(mL_per_min), drop, change),
                     "Raise the number of steps, or widen a channel that is nearly closed");
  }
  return flow;
}

}  // namespace manoscope::twin
