#include "manoscope/flow/plane_march.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "manoscope/core/error.hpp"
#include "manoscope/flow/spectral.hpp"

namespace manoscope::flow {
namespace {

constexpr const char* kWhere = "plane marching model";
using Vector = Eigen::VectorXd;

void check(const Array1& x, const Array1& gap, const Array1& side_factor, double flow) {
  if (x.size() < 3 || gap.size() != x.size() || side_factor.size() != x.size()) {
    throw InputError(kWhere,
                     fmt::format("{} gaps and {} side-wall factors at {} stations", gap.size(),
                                 side_factor.size(), x.size()),
                     "Give one of each a station, at three stations or more");
  }
  for (Index i = 0; i < x.size(); ++i) {
    if (gap(i) > 0.0 && std::isfinite(gap(i)) && side_factor(i) > 0.0 &&
        std::isfinite(side_factor(i))) {
      continue;
    }
    throw InputError(kWhere,
                     fmt::format("gap {:.4g} um and side-wall factor {:.4g} at station {}",
                                 gap(i) * 1e6, side_factor(i), i),
                     "Both must be positive; check the sign of zeta and the channel height");
  }
  if (!(flow > 0.0) || !std::isfinite(flow)) {
    throw InputError(kWhere, fmt::format("the flow per width is {:g} m2/s", flow),
                     "Give a positive flow rate: the march follows the flow");
  }
}

/// The march itself: u and p station after station.
class Marcher {
 public:
  Marcher(const PlaneMarchOptions& options, double flow, const Fluid& fluid)
      : basis_(chebyshev_basis(options.degree)),
        bend_(basis_.derivative * basis_.derivative),
        flow_(flow),
        density_(fluid.density.si()),
        nu_(fluid.kinematic_viscosity().si()) {}

  const NodalBasis& basis() const { return basis_; }

  void start(InletProfile inlet, double gap) {
    const Array1& t = basis_.nodes;
    u_ = inlet == InletProfile::developed ? Vector((t * (1.0 - t)).matrix())
                                          : Vector::Ones(t.size());
    u_(0) = u_(t.size() - 1) = 0.0;
    u_ *= flow_ / (gap * basis_.weights.matrix().dot(u_));
    psi_ = gap * (basis_.integral * u_);
    u_before_ = psi_before_ = Vector::Zero(t.size());
    pressure_ = pressure_before_ = 0.0;
    previous_step_ = 0.0;
  }

  /// One step to a station. False if Newton's iteration ends in no number.
  bool step(double step, double gap, double viscosity) {
    const auto derivative = BackwardDerivative::of(step, previous_step_);
    const Index n = u_.size();
    const Vector u_past = derivative.before * u_ + derivative.earlier * u_before_;
    const Vector psi_past = derivative.before * psi_ + derivative.earlier * psi_before_;
    const double p_past = derivative.before * pressure_ + derivative.earlier * pressure_before_;
    Vector u = u_;
    double p = pressure_;
    Matrix system(n + 1, n + 1);
    Vector rest(n + 1);
    const double friction = viscosity / (gap * gap);
    for (int newton = 0; newton < 12; ++newton) {
      const Vector u_x = derivative.now * u + u_past;
      const Vector psi_x = derivative.now * gap * (basis_.integral * u) + psi_past;
      const Vector u_t = basis_.derivative * u;
      const Vector carried = u.cwiseMax(0.0);  // FLARE: backflow carries nothing
      rest.head(n) =
          carried.cwiseProduct(u_x) - psi_x.cwiseProduct(u_t) / gap - friction * (bend_ * u);
      rest.head(n).array() += (derivative.now * p + p_past) / density_;
      auto block = system.topLeftCorner(n, n);
      block = -derivative.now * (u_t.asDiagonal() * basis_.integral);
      block.noalias() -= (psi_x / gap).asDiagonal() * basis_.derivative;
      block -= friction * bend_;
      for (Index k = 0; k < n; ++k) {
        block(k, k) += derivative.now * carried(k) + (u(k) > 0.0 ? u_x(k) : 0.0);
      }
      system.col(n).setConstant(derivative.now / density_);
      for (const Index wall : {Index{0}, n - 1}) {
        system.row(wall).setZero();
        system(wall, wall) = 1.0;
        rest(wall) = u(wall);
      }
      system.row(n).setZero();
      system.row(n).head(n) = gap * basis_.weights.matrix().transpose();
      rest(n) = gap * basis_.weights.matrix().dot(u) - flow_;
      // Rows in like units, so that pivots compare.
      const Vector scale = system.cwiseAbs().rowwise().maxCoeff().cwiseMax(1e-300).cwiseInverse();
      const Matrix scaled = scale.asDiagonal() * system;
      const Vector change = scaled.partialPivLu().solve(scale.cwiseProduct(rest));
      if (!change.allFinite() || change.cwiseAbs().maxCoeff() > 1e30) return false;
      u -= change.head(n);
      p -= change(n);
      // Newton is quadratic: the step after one of 1e-7 is below round-off.
      if (change.head(n).cwiseAbs().maxCoeff() < 1e-7 * u.cwiseAbs().maxCoeff()) break;
    }
    u_before_ = u_;
    psi_before_ = psi_;
    pressure_before_ = pressure_;
    u_ = u;
    psi_ = gap * (basis_.integral * u);
    pressure_ = p;
    previous_step_ = step;
    return true;
  }

  const Vector& velocity() const { return u_; }
  double pressure() const { return pressure_; }
  double nu() const { return nu_; }

 private:
  NodalBasis basis_;
  Matrix bend_;
  double flow_, density_, nu_;
  Vector u_, u_before_, psi_, psi_before_;
  double pressure_ = 0.0, pressure_before_ = 0.0, previous_step_ = 0.0;
};

/// df/dx at station i of values at stations, second order on uneven spacing.
template <class Rows>
Vector along(const Array1& x, const Rows& f, Index i) {
  const Index n = x.size();
  const Index j = std::clamp<Index>(i, 1, n - 2);
  const double left = x(j) - x(j - 1), right = x(j + 1) - x(j);
  const Vector below = ((f.row(j) - f.row(j - 1)) / left).transpose();
  const Vector above = ((f.row(j + 1) - f.row(j)) / right).transpose();
  const Vector bend = (above - below) / (left + right);
  const double shift = x(i) - x(j);
  return (right * below + left * above) / (left + right) + 2.0 * shift * bend;
}

/// Adds the pressure across the stream to the mean pressure at floor and roof.
void add_cross_stream(const NodalBasis& basis, const Array1& x, const Array1& gap,
                      const Fluid& fluid, PlaneMarch& march) {
  const Index n = x.size();
  const Matrix u = march.velocity.matrix();
  const Matrix psi = gap.matrix().asDiagonal() * (u * basis.integral.transpose());
  const Matrix h = gap.matrix();
  // d/dx at fixed y of a field f(x, t): f_x - t h'/h f_t.
  const auto at_fixed_y = [&](const Matrix& f, Index i) {
    const double slope = along(x, h, i)(0);
    return Vector(along(x, f, i) -
                  slope / gap(i) *
                      basis.nodes.matrix().cwiseProduct(basis.derivative * f.row(i).transpose()));
  };
  Matrix v(n, u.cols());
  for (Index i = 0; i < n; ++i) v.row(i) = -at_fixed_y(psi, i).transpose();
  const double rho = fluid.density.si(), eta = fluid.viscosity.si();
  for (Index i = 0; i < n; ++i) {
    const Vector v_i = v.row(i).transpose();
    const Vector v_y = basis.derivative * v_i / gap(i);
    const Vector p_y =
        -rho * (u.row(i).transpose().cwiseProduct(at_fixed_y(v, i)) + v_i.cwiseProduct(v_y)) +
        eta / gap(i) * (basis.derivative * v_y);
    const Vector p = gap(i) * (basis.integral * p_y);
    const double mean = basis.weights.matrix().dot(p);
    march.floor_pressure(i) = march.pressure(i) - mean;
    march.roof_pressure(i) = march.pressure(i) + p(p.size() - 1) - mean;
  }
}

}  // namespace

void PlaneMarchOptions::validate() const {
  if (degree >= 6 && degree <= 100) return;
  throw InputError(kWhere, fmt::format("a profile of degree {}", degree), "Give 6 to 100");
}

PlaneMarch march_plane(const Array1& x, const Array1& gap, const Array1& side_factor,
                       double flow_per_width, const Fluid& fluid,
                       const PlaneMarchOptions& options) {
  options.validate();
  fluid.validate(kWhere);
  check(x, gap, side_factor, flow_per_width);
  Marcher marcher(options, flow_per_width, fluid);
  const double nu = marcher.nu();
  const MarchGrid grid = march_grid(x, options.inlet, flow_per_width * gap(0) / nu);
  const Array1 gaps = on_grid(grid, gap), factors = on_grid(grid, side_factor);
  const NodalBasis& basis = marcher.basis();
  const Index n = x.size(), m = basis.nodes.size();

  PlaneMarch march{Array1::Zero(n),    Array1::Zero(n), Array1::Zero(n),
                   Array1::Zero(n),    Array1::Zero(n), basis.nodes,
                   Array2::Zero(n, m), Flags1::Zero(n), {}};
  bool answered = true;
  const auto keep = [&](Index i) {
    const Vector& u = marcher.velocity();
    march.velocity.row(i) = u.transpose().array();
    march.pressure(i) = marcher.pressure();
    const double slope = basis.derivative.row(0).dot(u);
    march.wall_shear(i) = fluid.viscosity.si() * slope / gap(i);
    march.momentum_factor(i) = gap(i) * gap(i) * basis.weights.matrix().dot(u.cwiseAbs2()) /
                               (flow_per_width * flow_per_width);
    if (!(slope > 0.0)) {
      march.flags(i) |= MarchFlag::separated;
      if (!march.first_separated) march.first_separated = i;
    }
  };
  marcher.start(options.inlet, gaps(0));
  keep(0);
  Index station = 1;
  for (Index i = 1; i < grid.x.size() && answered; ++i) {
    answered = marcher.step(grid.x(i) - grid.x(i - 1), gaps(i), nu / factors(i));
    if (answered && grid.stations[static_cast<std::size_t>(station)] == i) keep(station++);
  }
  flag_downstream(march.flags);
  if (!answered) {
    for (FlagBits& bits : march.flags) bits |= MarchFlag::no_answer;
    march.pressure.setConstant(std::numeric_limits<double>::quiet_NaN());
    march.roof_pressure = march.floor_pressure = march.pressure;
    return march;
  }
  march.pressure -= double(march.pressure(n - 1));
  add_cross_stream(basis, x, gap, fluid, march);
  return march;
}

}  // namespace manoscope::flow
