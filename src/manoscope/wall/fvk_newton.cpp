#include "manoscope/wall/fvk_newton.hpp"

#include <algorithm>
#include <cmath>

namespace manoscope::wall {
namespace {

using Vector = Eigen::VectorXd;

/// Step along d to the first minimum of the energy: the slope is a cubic, known from its values at
/// 0, 1/2, 1 and 2 (the first is negative). Steps are kept within [0.001, 100].
double first_minimum(const FvkModel& model, const Vector& q, const Vector& d, const Vector& load,
                     double slope_at_0) {
  const auto slope = [&](double step) { return d.dot(model.gradient(q + step * d) - load); };
  const double f0 = slope_at_0, f1 = slope(0.5), f2 = slope(1.0), f4 = slope(2.0);
  // Newton's divided differences at 0, 1/2, 1, 2.
  const double d01 = (f1 - f0) / 0.5, d12 = (f2 - f1) / 0.5, d24 = (f4 - f2) / 1.0;
  const double d012 = d12 - d01, d124 = (d24 - d12) / 1.5, d0124 = (d124 - d012) / 2.0;
  const auto cubic = [&](double t) {
    return f0 + t * (d01 + (t - 0.5) * (d012 + (t - 1.0) * d0124));
  };
  constexpr double kShortest = 1e-3, kLongest = 100.0, kGrowth = 1.02;
  double low = 0.0;
  for (double high = 0.01; high < kLongest; high *= kGrowth) {
    if (cubic(high) < 0.0) {
      low = high;
      continue;
    }
    double a = low, c = high;
    for (int n = 0; n < 50; ++n) {
      const double middle = 0.5 * (a + c);
      (cubic(middle) < 0.0 ? a : c) = middle;
    }
    return std::max(0.5 * (a + c), kShortest);
  }
  return kLongest;
}

}  // namespace

BlockTridiagonal flat_hessian(const FvkModel& model) {
  BlockTridiagonal hessian(model.block_sizes());
  FvkCoefficients slack = model.coefficients();
  slack.prestress = 0.0;
  FvkModel(model.x(), model.z(), slack, model.symmetric())
      .add_hessian(Vector::Zero(model.n_unknowns()), hessian);
  return hessian;
}

ResidualNorm::ResidualNorm(const FvkModel& model) : stiffness_(model.n_unknowns()) {
  const BlockTridiagonal flat = flat_hessian(model);
  Index at = 0;
  for (const Matrix& block : flat.diagonal) {
    stiffness_.segment(at, block.rows()) = block.diagonal().array();
    at += block.rows();
  }
}

double ResidualNorm::operator()(const Vector& imbalance, const Vector& magnitude) const {
  // The floor, forces of a deflection of about 1e-10 t, lets the flat wall at rest count as solved.
  constexpr double kFloor = 1e-10;
  const double scale = std::max(std::sqrt((magnitude.array().square() / stiffness_).sum()), kFloor);
  return std::sqrt((imbalance.array().square() / stiffness_).sum()) / scale;
}

double ResidualNorm::step(const Vector& d) const {
  return std::sqrt((d.array().square() * stiffness_).sum());
}

Equilibrium solve_equilibrium(const FvkModel& model, const ResidualNorm& norm, const Vector& load,
                              const Vector& start, const NewtonOptions& options,
                              const Monitor& monitor) {
  Equilibrium state;
  state.q = start;
  BlockTridiagonal hessian(model.block_sizes());
  const Vector load_magnitude = load.cwiseAbs();
  Vector magnitude;
  while (true) {
    const Vector imbalance = model.gradient(state.q, &magnitude) - load;
    state.residual = norm(imbalance, magnitude + load_magnitude);
    const bool balanced = state.residual <= options.tolerance;
    const bool stands = !options.stable || (state.tangent && state.tangent->n_negative() == 0);
    if (balanced && state.tangent && stands) {
      state.converged = true;
      return state;
    }
    if (state.iterations >= options.max_iterations) return state;
    monitor.checkpoint();
    hessian.set_zero();
    model.add_hessian(state.q, hessian);
    state.tangent = std::make_shared<const BlockFactorisation>(hessian);
    ++state.iterations;
    if (balanced && (!options.stable || state.tangent->n_negative() == 0)) {
      state.converged = true;
      return state;
    }
    Vector d;
    if (options.stable && state.tangent->n_negative() > 0) {
      if (balanced) {
        // A saddle: leave it along its softest direction, the way the load leans.
        d = load.squaredNorm() > 0.0 ? load : Vector::Ones(model.n_unknowns());
        for (int n = 0; n < 6; ++n) {
          d = state.tangent->solve(d.cwiseQuotient(Vector::Constant(d.size(), d.norm())));
        }
        d *= 0.1 * std::max(norm.step(state.q), 1.0) / norm.step(d);
        if (d.dot(load) < 0.0) d = -d;
        state.q += d;
        state.tangent.reset();
        continue;
      }
      // Stiffen by a share of the flat wall's own stiffness until the step points downhill.
      const BlockTridiagonal flat = flat_hessian(model);
      double added = 0.0, share = 0.01;
      while (true) {
        hessian.add(share - added, flat);
        added = share;
        const BlockFactorisation stiffened(hessian);
        ++state.iterations;
        if (stiffened.n_negative() == 0) {
          d = -stiffened.solve(imbalance);
          break;
        }
        share *= 4.0;
        monitor.checkpoint();
      }
    } else {
      d = -state.tangent->solve(imbalance);
    }
    double step = 1.0;
    const double slope = d.dot(imbalance);
    const bool far = norm.step(d) > 0.02 * norm.step(state.q);
    if (far && slope < 0.0) step = first_minimum(model, state.q, d, load, slope);
    state.q += step * d;
  }
}

}  // namespace manoscope::wall
