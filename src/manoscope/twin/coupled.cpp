#include "manoscope/twin/coupled.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "manoscope/core/error.hpp"
#include "manoscope/twin/modelled_flow.hpp"
#include "manoscope/twin/momentum_equation.hpp"
#include "manoscope/wall/clamped_wall.hpp"

namespace manoscope::twin {
namespace {

constexpr const char* kWhere = "coupled flow";
constexpr const char* kMendChoking =
    "Lower the flow rate, raise the outlet pressure, or take a stiffer wall: at S^2 = 1 the flow "
    "is "
    "as fast as the waves of the wall, and no steady flow exists beyond";
constexpr const char* kMendSeparation =
    "Lower the flow rate, choose flow_model = \"momentum\" or \"rectangle\", or take a wall that "
    "rises less steeply";
/// Largest relative change of the drop between n/2 and n steps; the error of n steps is a
/// fifteenth.
constexpr double kMostChange = 1e-3;
constexpr double kSettled = 1e-9;       // largest residual of p, of the drop
constexpr double kModelSettled = 1e-5;  // the same of a flow model
constexpr int kMostIterations = 20;     // of Newton's method at one flow rate
constexpr int kMostHalvings = 6;        // of one Newton step
constexpr double kNearlyChoked = 0.7;   // S^2 of the last flow found where no further one is
constexpr int kAcross = 15;  // points across at which contact with the floor is looked for
constexpr double kShortest = 1.0 / 64;  // of the way from the start to the flow rate asked for
/// The wall is loaded at so many even cells, p between the nodes by cubics: what p of the paper's
/// channels bends within one is below 1 mPa.
constexpr Index kLoadCells = 3840;

/// Nodes stand ten times closer at the ends than on average: with inertia, p follows the section
/// where the clamped wall rises within tens of micrometres.
constexpr double kGrading = 0.9;

/// The rectangle that a flow is coupled with, or that steers the solution of a flow model.
Rectangle rectangle_of(const CoupledOptions& options) {
  const std::optional<flow::FlowModel> model = options.model();
  const bool exact = model ? *model != flow::FlowModel::paper : options.exact_duct;
  const bool creeps = model == flow::FlowModel::paper || model == flow::FlowModel::creeping;
  return {exact ? flow::DuctFormula::series : flow::DuctFormula::wide_duct,
          creeps ? 0.0 : options.momentum_factor};
}

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

/// Refuses a flow that half the steps would move.
/// @param inlet, rough  its pressure at x = 0, and with half the steps, Pa.
void check_resolution(FlowRate flow_rate, double outlet, double inlet, double rough, Index steps) {
  const double drop = std::abs(inlet - outlet);
  const double change = std::isfinite(rough) ? std::abs(inlet - rough) : drop;
  if (change <= kMostChange * drop) return;
  throw InputError(kWhere,
                   fmt::format("{} steps do not resolve the flow at {:.3g} mL/min: half of them "
                               "move the drop of {:.4g} Pa by {:.3g} Pa",
                               steps, flow_rate.in(mL_per_min), drop, change),
                   "Raise the number of steps, or widen a channel that is nearly closed");
}

/// A flow that Newton's method has in hand.
struct Iterate {
  Array1 pressure;
  WallAtRest wall;
  Array1 zeta, residual;
  std::optional<Index> separated{};  ///< the first node where the flow of a model does
};

class Solver {
 public:
  Solver(const flow::Channel& channel, const flow::Fluid& fluid, const WallModel& wall,
         const CoupledOptions& options, const Monitor& monitor)
      : channel_(channel),
        wall_(wall),
        equation_(channel, fluid, rectangle_of(options), options.steps, kGrading),
        monitor_(monitor) {}

  /// From now on p is to be what a flow model says at the nodes; the rectangle still steers.
  void obey(ModelledFlow model) {
    model_ = std::move(model);
    settled_ = kModelSettled;
  }

  /// The flow near a start; none where Newton's method does not reach one.
  std::optional<Iterate> solve(double flow_rate, double outlet, const Array1& pressure,
                               const WallAtRest& from) {
    std::optional<Iterate> now = at(pressure, from, flow_rate, outlet);
    for (int n = 0; now && n < kMostIterations; ++n) {
      monitor_.checkpoint();
      const double largest = now->residual.abs().maxCoeff();
      const double drop = std::abs(now->pressure(0) - outlet);
      if (largest <= settled_ * drop || largest == 0.0) return now;
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
      if (!next && !model_ && largest <= 100.0 * kSettled * drop) return now;
      now = std::move(next);
    }
    return std::nullopt;
  }

  CoupledFlow finished(double flow_rate, Iterate flow) const {
    const Choking choking = choking_of(flow_rate, flow);
    if (choking.square >= 1.0) refuse_choking(flow_rate, choking);
    return {FlowRate::from_si(flow_rate),
            ChannelCurve(channel_.length, flow.pressure, kGrading),
            ChannelCurve(channel_.length, flow.zeta, kGrading),
            std::move(flow.wall),
            std::sqrt(std::max(choking.square, 0.0)),
            model_ ? model_->shape() : flow::WallShape::parabola()};
  }

  /// The flow of the model near that of the rectangle at the same flow rate.
  CoupledFlow modelled(const CoupledFlow& rectangle) {
    const double flow_rate = rectangle.flow_rate.si(), outlet = rectangle.outlet().si();
    auto found = solve(flow_rate, outlet, rectangle.pressure.values(), rectangle.wall);
    if (!found) refuse(flow_rate, outlet, flow_rate, {});
    if (found->separated) refuse_separation(*found->separated, rectangle.flow_rate);
    const double coarse = model_->coarse_pressure(found->zeta, outlet).pressure(0);
    check_resolution(rectangle.flow_rate, outlet, found->pressure(0), coarse, x().size() - 1);
    return finished(flow_rate, *std::move(found));
  }

  /// Says why there is no flow beyond the last one that was found.
  [[noreturn]] void refuse(double flow_rate, double outlet, double last_flow_rate,
                           const std::optional<Iterate>& last) const {
    // First: behind a separation a model says anything, and the wall is loaded with it.
    if (separated_) refuse_separation(*separated_, FlowRate::from_si(flow_rate));
    if (breaks_down_) refuse_breakdown(FlowRate::from_si(flow_rate));
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
    if (!model_) {
      made.residual = pressure - equation_.pressure(flow_rate, outlet, made.zeta);
      return made;
    }
    const flow::ModelledPressure said = model_->pressure(made.zeta, outlet);
    made.separated = separated_ = said.first_separated;
    breaks_down_ = !said.pressure.isFinite().all();
    if (breaks_down_) return std::nullopt;
    made.residual = pressure - said.pressure;
    return made;
  }

  std::string model_name() const {
    return std::string(flow::flow_model_info(model_->model()).name);
  }

  [[noreturn]] void refuse_breakdown(FlowRate flow_rate) const {
    throw InputError(kWhere,
                     fmt::format("the flow model \"{}\" breaks down at {:.4g} mL/min", model_name(),
                                 flow_rate.in(mL_per_min)),
                     kMendSeparation);
  }

  [[noreturn]] void refuse_separation(Index node, FlowRate flow_rate) const {
    throw InputError(
        kWhere,
        fmt::format("the flow separates from the wall at x = {:.4g} mm, {:.4g} mL/min: \"{}\" has "
                    "no answer downstream",
                    x()(node) * 1e3, flow_rate.in(mL_per_min), model_name()),
        kMendSeparation);
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
  std::optional<ModelledFlow> model_;  ///< what p is to meet; none: equation_
  double settled_ = kSettled;          ///< largest residual of p, of the drop
  const Monitor& monitor_;
  // Of the last wall that was tried:
  std::optional<Place> contact_;  ///< where it touched the floor
  std::optional<double> beyond_;  ///< pressure under which its law does not hold, Pa
  // Of the last wall that the model was asked about:
  std::optional<Index> separated_;  ///< node where the flow separates first
  bool breaks_down_ = false;        ///< it has no pressure
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
  const std::optional<flow::FlowModel> model = options.model();
  if (model && q != 0.0) {
    flow::FlowCase flowing{channel, fluid, flow_rate, solver.x(), {}};
    flowing.shape = section_shape(flow.wall, channel.length, channel.width);
    flowing.inlet = options.inlet();
    solver.obey(ModelledFlow(*model, std::move(flowing)));
    return solver.modelled(flow);
  }
  CoupledOptions half = options;
  half.steps /= 2;
  Solver rough(channel, fluid, wall, half, monitor);
  const auto check = rough.solve(q, outlet, flow.pressure(rough.x()), flow.wall);
  check_resolution(flow_rate, outlet, flow.inlet().si(), check ? check->pressure(0) : std::nan(""),
                   options.steps);
  return flow;
}

}  // namespace manoscope::twin
