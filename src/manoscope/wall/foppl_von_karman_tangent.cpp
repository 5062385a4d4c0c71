// What the factored tangent of a wall answers: rates, influence, buckling.
#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <utility>

#include "manoscope/core/error.hpp"
#include "manoscope/wall/foppl_von_karman_grid.hpp"
#include "manoscope/wall/line_load.hpp"

namespace manoscope::wall {
namespace {

using Vector = Eigen::VectorXd;

BlockFactorisation tangent_of(const FvkModel& model, const Vector& q) {
  BlockTridiagonal hessian(model.block_sizes());
  model.add_hessian(q, hessian);
  return BlockFactorisation(hessian);
}

}  // namespace

std::unique_ptr<WallState> FopplVonKarman::nearby_equilibrium(const WallLoad& load,
                                                              const WallState& start) const {
  NewtonOptions newton;
  newton.tolerance = options_.tolerance;
  newton.max_iterations = 8;
  newton.stable = false;
  Equilibrium found = solve_equilibrium(fine_->model, fine_->norm, scaled_load(*fine_, load),
                                        start.q_, newton, monitor_);
  if (!found.converged) return nullptr;
  auto state = std::make_unique<WallState>(start);
  state->q_ = std::move(found.q);
  state->residual_ = found.residual;
  state->iterations_ = found.iterations;
  state->n_unstable_ = found.tangent->n_negative();
  return state;
}

WallState FopplVonKarman::predicted(const WallState& start, double step, const Vector& rate) const {
  WallState state = start;
  state.q_ += step * rate;
  return state;
}

Vector FopplVonKarman::scaled_pressure(const WallLoad& load) const {
  return scaled_load(*fine_, load) - scaled_load(*fine_, WallLoad::uniform(Pressure{}));
}

Vector FopplVonKarman::rate(const WallState& state, const WallLoad& load) const {
  return tangent_of(fine_->model, state.q_).solve(scaled_pressure(load));
}

double FopplVonKarman::work(const WallState& state, const WallLoad& load) const {
  return fine_->halves * fine_->energy * scaled_pressure(load).dot(state.q_);
}

Matrix FopplVonKarman::influence(const WallState& state, const Array1& stations) const {
  // Checks the stations, too.
  const WallLoad checked = WallLoad::along(stations, Array1::Zero(stations.size()));
  const FvkModel& model = fine_->model;
  const double a = fine_->half_width;
  const Index n = stations.size();
  const Matrix weights = station_weights(model.x(), checked.x() / a);
  Matrix answers(model.n_unknowns(), n), sampled(model.n_unknowns(), n);
  for (Index j = 0; j < n; ++j) {
    answers.col(j) = model.line_functional(weights.col(j));
    const double at = stations(j) / a;
    const bool inside = at > 0.0 && at < model.x().last();
    sampled.col(j) = inside ? model.line_functional(sampling_weights(model.x(), at))
                            : Vector(Vector::Zero(model.n_unknowns()));
  }
  tangent_of(model, state.q_).solve_in_place(answers);
  return (fine_->thickness * 0.5 * fine_->halves / fine_->pressure) *
         (sampled.transpose() * answers);
}

Pressure FopplVonKarman::critical_prestress() const {
  // Largest eigenvalue of flat^-1 geometric by Lanczos with full reorthogonalisation in the inner
  // product of the flat wall's stiffness; the flat wall buckles at minus its inverse.
  const FvkModel& model = fine_->model;
  const BlockFactorisation flat(flat_hessian(model));
  BlockTridiagonal geometric(model.block_sizes());
  model.add_geometric_stiffness(geometric);
  Array1 ends(2), lopsided(2);
  ends << 0.0, model.x().last();
  lopsided << 1.0, 1.5;  // meets even and odd modes alike
  Vector force = model.line_functional(station_weights(model.x(), ends) * lopsided.matrix());
  Vector next = flat.solve(force);
  constexpr Index kMost = 120;
  Matrix basis(model.n_unknowns(), kMost), forces(model.n_unknowns(), kMost);
  Matrix ritz = Matrix::Zero(kMost, kMost);
  double largest = 0.0;
  for (Index k = 0; k < kMost; ++k) {
    const double length = std::sqrt(next.dot(force));
    basis.col(k) = next / length;
    forces.col(k) = force / length;
    const Vector image_force = geometric.multiply(basis.col(k));
    ritz.col(k).head(k + 1) = basis.leftCols(k + 1).transpose() * image_force;
    ritz.row(k).head(k + 1) = ritz.col(k).head(k + 1).transpose();
    const Eigen::SelfAdjointEigenSolver<Matrix> solver(ritz.topLeftCorner(k + 1, k + 1),
                                                       Eigen::EigenvaluesOnly);
    const double now = solver.eigenvalues()(k);
    if (k > 4 && std::abs(now - largest) <= 1e-13 * now) {
      const double nu = wall_.poisson_ratio, slenderness = fine_->half_width / fine_->thickness;
      return Pressure::from_si(-wall_.youngs_modulus.si() / (1.0 - nu * nu) /
                               (slenderness * slenderness) / now);
    }
    largest = now;
    force = image_force;
    next = flat.solve(force);
    for (int twice = 0; twice < 2; ++twice) {
      const Vector share = forces.leftCols(k + 1).transpose() * next;
      next -= basis.leftCols(k + 1) * share;
      force -= forces.leftCols(k + 1) * share;
    }
  }
  throw InputError("critical prestress", fmt::format("not settled after {} steps", kMost),
                   "Add cells to the grid");
}

}  // namespace manoscope::wall
