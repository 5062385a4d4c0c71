#include "manoscope/flow/section_march.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "manoscope/core/error.hpp"
#include "manoscope/flow/section_stepper.hpp"

namespace manoscope::flow {
namespace {

constexpr const char* kWhere = "marching model on sections";
constexpr double kSlowLayers = 5.0;  ///< c of the docstring of march_section()
/// Length over which a correction of the lateral pressure is smoothed, in heights of the channel: a
/// thin gap has no finer one, and without it roughness of the roof grows from sweep to sweep.
constexpr double kSmoothing = 0.25;

/// The lateral pressure as cosines: p2 = sum over j >= 1 of amplitude_j(x) cos(j pi s).
class LateralPressure {
 public:
  LateralPressure(const EvenBasis& across, double half_width, int modes, const Array1& x,
                  double smoothing)
      : smoothing_(smoothing), x_(x), waves_(modes), cosines_(modes, across.nodes.size()) {
    for (int j = 0; j < modes; ++j) {
      waves_(j) = (j + 1) * std::numbers::pi / half_width;
      cosines_.row(j) = ((j + 1) * std::numbers::pi * across.nodes).cos().transpose().matrix();
    }
    // An odd polynomial in s to its first sines: 2 int_0^1 f sin(j pi s) ds.
    const QuadratureRule rule = gauss_legendre(40);
    const Array1 s = 0.5 * (1.0 + rule.nodes);
    const Index n_odd = across.odd_transform.rows();
    Matrix odd(s.size(), n_odd);
    for (Index k = 0; k < n_odd; ++k) {
      odd.col(k) = ((2.0 * static_cast<double>(k) + 1.0) * s.acos()).cos().matrix();
    }
    Matrix sines(modes, s.size());
    for (int j = 0; j < modes; ++j) {
      sines.row(j) = (rule.weights * ((j + 1) * std::numbers::pi * s).sin()).transpose().matrix();
    }
    to_sines_ = sines * odd * across.odd_transform;
    amplitudes_ = Matrix::Zero(x.size(), modes);
  }

  /// p2 at the nodes across of a station, Pa.
  Array1 at(Index station) const {
    return (amplitudes_.row(station) * cosines_).transpose().array();
  }
  /// dp2/dx that drives the step to a station. Taken downstream: with the derivatives upstream of
  /// the velocities it makes the second difference of an elliptic equation.
  Array1 push(Index station) const {
    const Index i = std::min(station, x_.size() - 2);
    return (at(i + 1) - at(i)) / (x_(i + 1) - x_(i));
  }

  void scale(double ratio) { amplitudes_ *= ratio; }

  /// Corrects p2 towards the pressure gradient across that the momentum wants.
  /// @param wanted  (n, n_s) dp2/dz at the nodes, Pa/m.
  /// @return greatest change, Pa.
  double correct(const Matrix& wanted) {
    const Matrix wanted_sines = wanted * to_sines_.transpose();
    double greatest = 0.0;
    for (Index j = 0; j < waves_.size(); ++j) {
      const double k = waves_(j);
      // c d'' - k^2 d = -k (present - wanted), present = -k amplitude.
      const Array1 source = k * (-k * amplitudes_.col(j) - wanted_sines.col(j)).array();
      Array1 change = solve(kSlowLayers, k * k, source, true);
      for (int pass = 0; pass < 2; ++pass)
        change = solve(smoothing_ * smoothing_, 1.0, change, false);
      amplitudes_.col(j) += change.matrix();
      greatest = std::max(greatest, change.abs().maxCoeff());
    }
    return greatest;
  }

 private:
  /// d of -spread d'' + hold d = source with d' = 0 at the inlet and d = 0 at the outlet. A first
  /// station is `free` of the source: no step leads to it.
  Array1 solve(double spread, double hold, const Array1& source, bool free) const {
    const Index n = x_.size();
    Array1 over(n), d(n);  // Thomas' algorithm
    over(0) = 1.0;
    d(0) = 0.0;
    if (!free) {
      const double ahead = x_(1) - x_(0), high = 2.0 * spread / (ahead * ahead);
      over(0) = high / (high + hold);
      d(0) = source(0) / (high + hold);
    }
    for (Index i = 1; i < n - 1; ++i) {
      const double back = x_(i) - x_(i - 1), ahead = x_(i + 1) - x_(i);
      const double low = spread / (back * back), high = spread / (back * ahead);
      const double pivot = low + high + hold - low * over(i - 1);
      over(i) = high / pivot;
      d(i) = (low * d(i - 1) + source(i)) / pivot;
    }
    d(n - 1) = 0.0;
    for (Index i = n - 1; i-- > 0;) d(i) += over(i) * d(i + 1);
    return d;
  }

  double smoothing_;
  Array1 x_, waves_;
  Matrix cosines_, to_sines_, amplitudes_;
};

/// dp2/dz at the nodes that the momentum across wants at a station.
Array1 wanted_gradient(const SectionState& state, const SectionState& before, double step,
                       const EvenBasis& across, double half_width, const Fluid& fluid) {
  const auto carried = [&](const SectionState& at) {
    return Array1(at.turning * at.gap * at.mean_square);
  };
  const Array1 square = state.turning * carried(state);
  const Array1 along = (carried(state) - carried(before)) / step;
  const Array1 aside = (across.even_slope * square.matrix()).array() / half_width;
  Array1 gradient = -fluid.density.si() / state.gap * (along + aside) -
                    fluid.viscosity.si() * state.turning * state.shear / state.gap;
  gradient(gradient.size() - 1) = 0.0;
  return gradient;
}

void check(const Array1& x, const Array2& gaps, Index nodes, FlowRate flow_rate) {
  if (x.size() < 3 || gaps.rows() != x.size() || gaps.cols() != nodes) {
    throw InputError(kWhere,
                     fmt::format("gaps at {} stations and {} places across, for {} stations and {} "
                                 "nodes",
                                 gaps.rows(), gaps.cols(), x.size(), nodes),
                     "Give one gap a node at every station, at three stations or more");
  }
  for (Index i = 0; i < x.size(); ++i) {
    const double least = gaps.row(i).minCoeff();
    if (least > 0.0 && gaps.row(i).isFinite().all()) continue;
    throw InputError(
        kWhere, fmt::format("the gap is {:.4g} um at x = {:.6g} mm", least * 1e6, x(i) * 1e3),
        "The gap must be positive and finite; check the sign of zeta and the channel height");
  }
  if (!(flow_rate.si() > 0.0) || !std::isfinite(flow_rate.si())) {
    throw InputError(kWhere, fmt::format("the flow rate is {:g} mL/min", flow_rate.in(mL_per_min)),
                     "Give a positive flow rate: the march follows the flow");
  }
}

/// Sweeps along one channel, with the lateral pressure that they build up.
class Sweeper {
 public:
  Sweeper(const Channel& channel, const Fluid& fluid, FlowRate flow_rate, const Array1& x,
          const Array2& gaps, const SectionMarchOptions& options)
      : channel_(channel),
        fluid_(fluid),
        inlet_(options.inlet),
        stepper_(channel, fluid, flow_rate.si(), options.nodes_across, options.degree_up),
        grid_(march_grid(
            x, options.inlet,
            flow_rate.si() / channel.width.si() * gaps(0, 0) / fluid.kinematic_viscosity().si())),
        gaps_(grid_.x.size(), gaps.cols()),
        lateral_(stepper_.across_basis(), 0.5 * channel.width.si(), options.modes, grid_.x,
                 kSmoothing * channel.height.si()) {
    for (Index s = 0; s < gaps.cols(); ++s) gaps_.col(s) = on_grid(grid_, gaps.col(s));
  }

  /// One sweep with a part of the fluid's density, and the correction of the lateral pressure.
  /// @return false if the march broke down or met backflow.
  bool correct(double inertia) {
    Fluid fluid = fluid_;
    fluid.density = inertia * fluid_.density;
    Matrix wanted = Matrix::Zero(gaps_.rows(), gaps_.cols());
    SectionState before;
    bool attached = true;
    const bool answered = sweep(inertia, 0, [&](Index i) {
      SectionState state = stepper_.state();
      attached = attached && !stepper_.separated();
      if (i > 0) {
        wanted.row(i) = wanted_gradient(state, before, grid_.x(i) - grid_.x(i - 1),
                                        stepper_.across_basis(), 0.5 * channel_.width.si(), fluid)
                            .transpose()
                            .matrix();
      }
      before = std::move(state);
    });
    if (answered) last_change_ = lateral_.correct(wanted);
    return answered && attached;
  }

  /// The lateral pressure of another density, as inertia has it.
  void scale(double ratio) { lateral_.scale(ratio); }

  /// The last sweep, kept. @return false if it broke down.
  bool finish(SectionMarch& march) {
    march.last_change = last_change_;
    Index station = 0;
    return sweep(1.0, 1, [&](Index i) {
      if (grid_.stations[static_cast<std::size_t>(station)] != i) return;
      const Array1 p2 = lateral_.at(i);
      const Array1 strips = stepper_.across_basis().weights * gaps_.row(i).transpose();
      march.roof_pressure(station) = stepper_.pressure();
      march.pressure(station) = stepper_.pressure() + (strips * p2).sum() / strips.sum();
      march.crest_pressure(station) = stepper_.pressure() + p2(0);
      march.momentum_factor(station) = stepper_.momentum_factor();
      march.floor_shear(station) = stepper_.floor_shear();
      march.roof_shear(station) = stepper_.roof_shear();
      if (stepper_.separated()) {
        march.flags(station) |= MarchFlag::separated;
        if (!march.first_separated) march.first_separated = station;
      }
      ++station;
    });
  }

 private:
  template <class Visit>
  bool sweep(double inertia, int repeats, Visit&& visit) {
    stepper_.start(inlet_, gaps_.row(0).transpose(), inertia);
    visit(Index{0});
    for (Index i = 1; i < grid_.x.size(); ++i) {
      if (!stepper_.step(grid_.x(i) - grid_.x(i - 1), gaps_.row(i).transpose(), lateral_.push(i),
                         repeats)) {
        return false;
      }
      visit(i);
    }
    return true;
  }

  Channel channel_;
  Fluid fluid_;
  InletProfile inlet_;
  SectionStepper stepper_;
  MarchGrid grid_;
  Array2 gaps_;  ///< (n, n_s) m
  LateralPressure lateral_;
  double last_change_ = 0.0;
};

}  // namespace

void SectionMarchOptions::validate() const {
  const auto check_count = [](const char* name, int value, int least, int most) {
    if (value >= least && value <= most) return;
    throw InputError(kWhere, fmt::format("{} is {}", name, value),
                     fmt::format("Give {} to {}", least, most));
  };
  check_count("nodes_across", nodes_across, 4, 40);
  check_count("degree_up", degree_up, 4, 40);
  check_count("modes", modes, 0, nodes_across / 2);
  check_count("sweeps", sweeps, 0, 100);
}

Array1 section_march_nodes(const SectionMarchOptions& options) {
  options.validate();
  return even_chebyshev_basis(options.nodes_across).nodes;
}

SectionMarch march_section(const Channel& channel, const WallShape& shape, const Fluid& fluid,
                           FlowRate flow_rate, const Array1& x, const Array1& zeta,
                           const SectionMarchOptions& options) {
  if (zeta.size() != x.size()) {
    throw InputError(kWhere, fmt::format("{} deflections at {} stations", zeta.size(), x.size()),
                     "Give one deflection a station");
  }
  const Array1 form =
      section_march_nodes(options).unaryExpr([&](double s) { return shape.value(s); });
  const Array2 gaps = channel.height.si() + (zeta.matrix() * form.matrix().transpose()).array();
  return march_section(channel, fluid, flow_rate, x, gaps, options);
}

SectionMarch march_section(const Channel& channel, const Fluid& fluid, FlowRate flow_rate,
                           const Array1& x, const Array2& gaps,
                           const SectionMarchOptions& options) {
  options.validate();
  channel.validate(kWhere);
  fluid.validate(kWhere);
  check(x, gaps, options.nodes_across + 1, flow_rate);
  const auto make = [&] { return Sweeper(channel, fluid, flow_rate, x, gaps, options); };
  Sweeper sweeper = make();
  const int sweeps = options.modes > 0 ? options.sweeps : 0;
  bool attached = true;
  for (int sweep = 0; sweep < sweeps && attached; ++sweep) attached = sweeper.correct(1.0);
  if (!attached) {
    // Without the lateral pressure the flow may separate where with it, it does not: it is built up
    // while the inertia grows.
    sweeper = make();
    constexpr int kSteps = 8;
    for (int step = 1; step <= kSteps; ++step) {
      sweeper.correct(double(step) / kSteps);
      if (step < kSteps) sweeper.scale((step + 1.0) / step);
    }
    for (int sweep = 0; sweep < sweeps; ++sweep) sweeper.correct(1.0);
  }
  const Index stations = x.size();
  const Array1 zero = Array1::Zero(stations);
  SectionMarch march{zero, zero, zero, zero, zero, zero, Flags1::Zero(stations), {}, 0.0};
  const bool answered = sweeper.finish(march);
  flag_downstream(march.flags);
  if (!answered) {
    for (FlagBits& bits : march.flags) bits |= MarchFlag::no_answer;
    march.pressure.setConstant(std::numeric_limits<double>::quiet_NaN());
    march.roof_pressure = march.crest_pressure = march.pressure;
    return march;
  }
  const double outlet = march.pressure(stations - 1);
  march.pressure -= outlet;
  march.roof_pressure -= outlet;
  march.crest_pressure -= outlet;
  return march;
}

}  // namespace manoscope::flow
