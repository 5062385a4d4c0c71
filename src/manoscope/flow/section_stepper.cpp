#include "manoscope/flow/section_stepper.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "manoscope/core/error.hpp"

namespace manoscope::flow {

SectionStepper::SectionStepper(const Channel& channel, const Fluid& fluid, double flow_rate,
                               int nodes_across, int degree_up)
    : half_width_(0.5 * channel.width.si()),
      full_density_(fluid.density.si()),
      density_(fluid.density.si()),
      viscosity_(fluid.viscosity.si()),
      flow_(flow_rate),
      across_(even_chebyshev_basis(nodes_across)),
      up_(chebyshev_basis(degree_up)),
      n_across_(nodes_across),
      n_up_(degree_up - 1) {
  const Index ns = n_across_, nt = n_up_;
  slope_even_ = across_.even_slope.topLeftCorner(ns, ns);
  slope_odd_ = across_.odd_slope.topLeftCorner(ns, ns);
  bend_ = across_.even_bend.topLeftCorner(ns, ns);
  const Matrix bend_up = up_.derivative * up_.derivative;
  slope_up_ = up_.derivative.block(1, 1, nt, nt);
  bend_up_ = bend_up.block(1, 1, nt, nt);
  rise_ = up_.integral.block(1, 1, nt, nt);
  mean_up_ = up_.weights.segment(1, nt);
  to_side_ = -across_.integral.topLeftCorner(ns, ns);
  to_side_.rowwise() += across_.weights.head(ns).matrix().transpose();
}

Array1 SectionStepper::depth_mean(const Matrix& u) const {
  return (u.transpose() * mean_up_.matrix()).array();
}

Matrix SectionStepper::laplacian(const Array1& gap) const {
  // z-derivative at fixed y: d_s - t g d_t with g = h_s/h; twice, with the terms sorted.
  const Index ns = n_across_, nt = n_up_;
  const Array1 slope = (across_.even_slope * gap.matrix()).array() / gap;
  const Array1 bend = (across_.even_bend * gap.matrix()).array() / gap - slope.square();
  const Array1 t = up_.nodes.segment(1, nt);
  const Matrix t_slope = t.matrix().asDiagonal() * slope_up_;
  const Matrix t_bend = t.square().matrix().asDiagonal() * bend_up_;
  const double scale = 1.0 / (half_width_ * half_width_);
  Matrix result(ns * nt, ns * nt);
  for (Index j = 0; j < ns; ++j) {
    for (Index i = 0; i < ns; ++i) {
      auto block = result.block(i * nt, j * nt, nt, nt);
      block = (-2.0 * scale * slope(i) * slope_even_(i, j)) * t_slope;
      block.diagonal().array() += scale * bend_(i, j);
    }
    const double g = slope(j);
    result.block(j * nt, j * nt, nt, nt) +=
        scale * ((g * g - bend(j)) * t_slope + g * g * t_bend) + 1.0 / (gap(j) * gap(j)) * bend_up_;
  }
  return result;
}

void SectionStepper::start(InletProfile inlet, const Array1& gap, double inertia) {
  density_ = inertia * full_density_;
  backflow_ = false;
  const Index ns = n_across_, nt = n_up_;
  if (inlet == InletProfile::developed) {
    const Vector developed = laplacian(gap).partialPivLu().solve(Vector::Constant(ns * nt, -1.0));
    u_ = Eigen::Map<const Matrix>(developed.data(), nt, ns);
  } else {
    u_ = Matrix::Ones(nt, ns);
  }
  const double flux =
      2.0 * half_width_ * (across_.weights.head(ns) * gap.head(ns) * depth_mean(u_)).sum();
  u_ *= flow_ / flux;
  u_before_ = Matrix::Zero(nt, ns);
  gap_ = gap_before_ = gap;
  turning_ = Array1::Zero(ns + 1);
  pressure_ = pressure_before_ = previous_step_ = 0.0;
}

void SectionStepper::add_convection(const BackwardDerivative& derivative, const Array1& gap,
                                    const Matrix& predicted, const Matrix& u_past,
                                    const Matrix& flux_past, Matrix& system, Vector& right) {
  // h u u_x + W u_s + V u_t with W = m h u (in units of half the width), M(s) = int_s^1 mean(h
  // u)_x, m = M / mean(h u), V = -int_0^t [(h u)_x + W_s]. The profile u / mean(u) is the predicted
  // one.
  const Index ns = n_across_, nt = n_up_;
  const Matrix across = predicted * slope_even_.transpose();
  const Matrix up = slope_up_ * predicted;
  const Array1 mean = depth_mean(predicted);
  const double floor = 1e-6 * mean.abs().maxCoeff();  // a mean that vanishes has no profile
  Matrix profile(nt, ns);
  for (Index s = 0; s < ns; ++s) profile.col(s) = predicted.col(s) / std::max(mean(s), floor);
  const Matrix risen = rise_ * profile;
  const Matrix carried = predicted.cwiseMax(0.0);  // FLARE: backflow carries nothing
  const Array1 past_mean = depth_mean(flux_past);

  Matrix of_mean(nt * ns, ns);  // what the depth means of (h u)_x do to each node
  for (Index t = 0; t < nt; ++t) {
    const Matrix lift = slope_odd_ * risen.row(t).transpose().asDiagonal() * to_side_;
    for (Index s = 0; s < ns; ++s) {
      of_mean.row(s * nt + t) =
          across(t, s) * profile(t, s) * to_side_.row(s) - up(t, s) * lift.row(s);
    }
  }
  const Vector from_past = of_mean * past_mean.matrix();
  const double now = derivative.now;
  for (Index j = 0; j < ns; ++j) {
    const double weight = now * gap(j);
    system.middleCols(j * nt, nt).noalias() +=
        (weight * of_mean.col(j)) * mean_up_.matrix().transpose();
  }
  for (Index s = 0; s < ns; ++s) {
    auto block = system.block(s * nt, s * nt, nt, nt);
    block.noalias() -= (now * gap(s) * up.col(s)).asDiagonal() * rise_;
    block.diagonal() += now * gap(s) * carried.col(s);
    right.segment(s * nt, nt) -= gap(s) * carried.col(s).cwiseProduct(u_past.col(s)) -
                                 up.col(s).cwiseProduct(rise_ * flux_past.col(s)) +
                                 from_past.segment(s * nt, nt);
  }
}

bool SectionStepper::step(double step, const Array1& gap, const Array1& push, int repeats) {
  const Index ns = n_across_, nt = n_up_, n = ns * nt;
  const auto derivative = BackwardDerivative::of(step, previous_step_);
  const Matrix u_past = derivative.before * u_ + derivative.earlier * u_before_;
  const Matrix flux_past =
      derivative.before * (u_ * gap_.head(ns).matrix().asDiagonal()) +
      derivative.earlier * (u_before_ * gap_before_.head(ns).matrix().asDiagonal());
  const double p_past = derivative.before * pressure_ + derivative.earlier * pressure_before_;
  Matrix predicted = u_;
  if (previous_step_ > 0.0) predicted += (step / previous_step_) * (u_ - u_before_);

  const double nu = viscosity_ / density_;
  Matrix friction = laplacian(gap);
  for (Index s = 0; s < ns; ++s) friction.middleRows(s * nt, nt) *= -nu * gap(s);
  const auto flux = [&](const Matrix& u) {
    return 2.0 * half_width_ * (across_.weights.head(ns) * gap.head(ns) * depth_mean(u)).sum();
  };
  Matrix u;
  double gradient = 0.0;  // derivative.now * p
  for (int repeat = 0; repeat <= repeats; ++repeat) {
    Matrix system = friction;
    Vector forces(n);
    Matrix right(n, 2);
    for (Index s = 0; s < ns; ++s) {
      forces.segment(s * nt, nt).setConstant(-gap(s) / density_ * (p_past + push(s)));
      right.col(1).segment(s * nt, nt).setConstant(-gap(s) / density_);
    }
    add_convection(derivative, gap, predicted, u_past, flux_past, system, forces);
    right.col(0) = forces;
    // u = forced + gradient * driven, and the gradient from the flow rate.
    const Matrix solution = system.partialPivLu().solve(right);
    if (!solution.allFinite() || solution.cwiseAbs().maxCoeff() > 1e100) return false;
    const Eigen::Map<const Matrix> forced(solution.col(0).data(), nt, ns);
    const Eigen::Map<const Matrix> driven(solution.col(1).data(), nt, ns);
    const double answer = flux(driven);
    if (answer == 0.0) return false;
    gradient = (flow_ - flux(forced)) / answer;
    u = forced + gradient * driven;
    // Developed flow has 2.4 times its mean at most; behind a separation the march may run away.
    const double mean = flow_ / (2.0 * half_width_ * (across_.weights * gap).sum());
    if (!(u.cwiseAbs().maxCoeff() < 20.0 * mean)) return false;
    predicted = u;
  }
  // Backflow is cut off (and told), or it would grow: the march cannot know where it comes from.
  backflow_ = (u.array() < 0.0).any();
  if (backflow_) {
    u = u.cwiseMax(0.0);
    u *= flow_ / flux(u);
  }

  const Array1 mean_flux = depth_mean(u) * gap.head(ns);
  const Array1 turned =
      (to_side_ * (derivative.now * mean_flux + depth_mean(flux_past)).matrix()).array();
  turning_ = Array1::Zero(ns + 1);
  const double least = 1e-6 * mean_flux.abs().maxCoeff();
  for (Index s = 1; s < ns; ++s) turning_(s) = turned(s) / std::max(mean_flux(s), least);

  u_before_ = u_;
  gap_before_ = gap_;
  pressure_before_ = pressure_;
  u_ = u;
  gap_ = gap;
  pressure_ = gradient / derivative.now;
  previous_step_ = step;
  return true;
}

SectionState SectionStepper::state() const {
  const Index ns = n_across_, nt = n_up_;
  SectionState state{gap_, half_width_ * turning_, Array1::Zero(ns + 1), Array1::Zero(ns + 1)};
  state.mean_square.head(ns) = depth_mean(u_.cwiseAbs2());
  const Index top = nt + 1;
  const Eigen::RowVectorXd ends =  // both outward
      up_.derivative.row(0).segment(1, nt) - up_.derivative.row(top).segment(1, nt);
  state.shear.head(ns) = (ends * u_).transpose().array() / gap_.head(ns);
  return state;
}

double SectionStepper::floor_shear() const {
  const Index ns = n_across_, nt = n_up_;
  const Array1 slope = (up_.derivative.row(0).segment(1, nt) * u_).transpose().array();
  return viscosity_ * (across_.weights.head(ns) * slope / gap_.head(ns)).sum();
}

double SectionStepper::roof_shear() const {
  const Index ns = n_across_, nt = n_up_;
  const Array1 slope = -(up_.derivative.row(nt + 1).segment(1, nt) * u_).transpose().array();
  return viscosity_ * (across_.weights.head(ns) * slope / gap_.head(ns)).sum();
}

double SectionStepper::momentum_factor() const {
  const Index ns = n_across_;
  const double area = 2.0 * half_width_ * (across_.weights * gap_).sum();
  const double square =
      2.0 * half_width_ *
      (across_.weights.head(ns) * gap_.head(ns) * depth_mean(u_.cwiseAbs2())).sum();
  return area * square / (flow_ * flow_);
}

bool SectionStepper::separated() const { return backflow_; }

}  // namespace manoscope::flow
