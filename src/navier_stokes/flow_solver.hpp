#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "manoscope/core/monitor.hpp"

namespace manoscope::navier_stokes {

template <int dim>
using Vector = std::array<double, dim>;

/// What holds on one side of the mesh.
enum class SideCondition {
  wall,      ///< no slip
  velocity,  ///< a given velocity
  slip,      ///< no flow through, no friction; the side must be a plane of constant x, y or z
  open,      ///< do nothing: du/dn - p n = 0
};

/// How the linear systems are solved.
enum class SolverKind {
  direct,     ///< LU factors: the quickest for some 100,000 unknowns
  iterative,  ///< Krylov steps, preconditioned: memory in proportion to the unknowns
};

template <int dim>
struct Side {
  SideCondition condition = SideCondition::wall;
  std::function<Vector<dim>(const Vector<dim>& place)> velocity;  ///< for SideCondition::velocity
};

/// Sides in the order of FlowProblem::sides; centre and flank in three dimensions only.
enum SideName : int { inlet = 0, outlet = 1, floor = 2, roof = 3, centre = 4, flank = 5 };

/// Weight of the grad-div term in a channel, and where a flow is not found without it. In the
/// bulged channels of docs/simulation.md at 70 mL/min it takes the error of p from 0.30 to 0.07 %
/// of the drop on 18 x 3 x 5 cubic cells and from 0.024 to 0.014 % in the plane; ten times as much
/// moves the drop by as much as a coarse mesh does.
inline constexpr double kGradDiv = 0.01;

/// Steady incompressible flow through a lattice of cells, free of units.
///
///   Re (u . grad) u - laplace u + grad p = f,  div u = 0
///
/// with lengths in some L, velocities in some U, p in eta U/L, Re = rho U L/eta, f in eta U/L^2.
/// A point of the lattice, its chart, stands at place(chart) in space; the first coordinate of both
/// is x.
template <int dim>
struct FlowProblem {
  std::array<std::vector<double>, dim> edges;  ///< of the cells along each axis; ascending
  std::function<Vector<dim>(const Vector<dim>& chart)> place;
  /// Cells without fluid, by the middle of their chart; their faces are walls. Empty: none.
  std::function<bool(const Vector<dim>& chart)> solid;
  double reynolds = 0.0;
  int order = 2;                         ///< of the velocities, one more than that of p; 2 to 4
  std::array<Side<dim>, 2 * dim> sides;  ///< of the lattice
  /// Walls slip upstream of this x; the gap must be constant there.
  double slip_before = -std::numeric_limits<double>::infinity();
  /// What flows in where velocities are given, which are scaled to it, in U L^(dim - 1).
  std::optional<double> inlet_flow;
  std::function<Vector<dim>(const Vector<dim>& place)> force;  ///< f; empty: none
  /// A velocity near the flow's, which the iteration starts from; empty: that of Stokes flow.
  std::function<Vector<dim>(const Vector<dim>& chart)> start;
  SolverKind solver = SolverKind::direct;
  /// Weight of -Re grad(div u) in the equations, 0 for the exact flow: on coarse meshes Newton's
  /// method lives on it. Where no flow is found, or systems are solved by iteration, the solver
  /// takes more.
  double grad_div = 0.0;
};

/// Charts (x, t[, z]) below a roof: y = t h(x, z) up to the roof at t = 1, and at unit steep
/// beyond.
/// @param gap  h(x, z) > 0; z is 0 in two dimensions.
template <int dim>
std::function<Vector<dim>(const Vector<dim>&)> below_roof(
    std::function<double(double x, double z)> gap) {
  return [gap = std::move(gap)](const Vector<dim>& chart) {
    Vector<dim> place = chart;
    double z = 0.0;
    if constexpr (dim == 3) z = chart[2];
    const double h = gap(chart[0], z);
    place[1] = chart[1] <= 1.0 ? chart[1] * h : h + (chart[1] - 1.0);
    return place;
  };
}

/// What a solution took.
struct FlowCosts {
  double n_unknowns = 0.0;
  int n_newton_steps = 0;         ///< linear systems solved
  int n_iterations = 0;           ///< Krylov steps in all
  double largest_residual = 0.0;  ///< worst |b - A x| / |b|
  bool grad_div = false;          ///< the term is in the equations
};

/// Values at one place.
template <int dim>
struct FlowPoint {
  Vector<dim> place{}, velocity{};
  double pressure = 0.0;
};

/// The flow in the cells of this process, each cut into `order` parts along each axis.
template <int dim>
struct FlowPiece {
  std::vector<FlowPoint<dim>> points;
  std::vector<std::array<std::size_t, 1 << dim>> cells;  ///< corners, the first axis fastest
};

/// Values over one section of a lattice whose t runs from 0 on the floor to 1 on the roof, free of
/// units.
struct FlowSection {
  double mean_pressure = 0.0;   ///< over the area
  double roof_pressure = 0.0;   ///< on the roof at z = 0
  double floor_pressure = 0.0;  ///< on the floor at z = 0
  double roof_shear = 0.0;      ///< along the roof at z = 0, in eta U/L, > 0 with the flow
  double floor_shear = 0.0;     ///< along the floor at z = 0
  double flow = 0.0;            ///< through the section
};

/// Values over the fluid's faces on one side of a lattice, free of units.
struct FlowSide {
  double mean_pressure = 0.0;  ///< over the area
  double outflow = 0.0;        ///< out through them; < 0 where the fluid enters
};

/// Taylor-Hood finite elements for a FlowProblem: Q_k velocities, Q_(k-1) pressure, cells mapped to
/// their place by polynomials of degree k. All processes that `mpirun` started share the columns of
/// the lattice; every call is made by all of them and answers the same to all.
///
/// Weak form: for all v, q that vanish where values are given,
///   Re ((u . grad) u, v) + (grad u, grad v) - (p, div v) - (q, div u) = (f, v),
/// whose natural condition is SideCondition::open. Without an open side p is 0 at one node. There
/// is, and on the left, where `grad_div` is given, grad_div Re (div u, div v), 0 for the exact
/// flow. Newton's iteration with the exact derivative, from `start`, or from Stokes flow where
/// there is none; where that does not lead to `reynolds`, as on coarse meshes, with a weight of
/// kGradDiv at least from Stokes flow, by steps in the Reynolds number that halve where it fails.
/// SolverKind::iterative has a weight of 0.1 from the beginning: its preconditioner lives on it.
/// Every solution of a linear system is checked (LinearSolver); without one that counts the
/// iteration has failed. Source: e.g. H. Elman, D. Silvester & A. Wathen, Finite Elements and Fast
/// Iterative Solvers (2014), ch. 8.
///
/// Errors in the 2-norm fall with h^(k+1) in u and h^k in p where the solution is smooth (test for
/// k = 2, 3). Pressure is unbounded in corners where given velocities clash or where the inlet
/// meets a wall that turns there.
template <int dim>
class FlowSolver {
 public:
  /// @throws InputError for an order or edges out of range.
  explicit FlowSolver(const FlowProblem<dim>& problem);
  ~FlowSolver();
  FlowSolver(FlowSolver&&) noexcept;
  FlowSolver& operator=(FlowSolver&&) = delete;

  /// @param checkpoint  file that keeps the state after every step, and from which a solution that
  ///                    was stopped goes on; "" none. What is in it of another problem is replaced.
  /// @throws InputError if Newton's iteration finds no steady flow, memory does not suffice or the
  ///         checkpoint cannot be written, InternalError from LinearSolver, Interrupted on request.
  void solve(const Monitor& monitor = {}, const std::filesystem::path& checkpoint = {});
  const FlowCosts& costs() const;

  /// Values at a chart of the lattice, where there is fluid.
  FlowPoint<dim> at(const Vector<dim>& chart) const;
  /// Values over the sections at `x`; shears are the mean of both cells where x is an edge.
  std::vector<FlowSection> sections(const std::vector<double>& x) const;
  FlowSection section(double x) const { return sections({x}).front(); }

  /// Force of the flow on all cells that are taken out, in eta U L^(dim - 2).
  ///
  ///   F_c = -[Re ((u . grad) u_c, v) + (grad u_c, grad v) - (p, dv/dx_c) - (f_c, v)]
  ///
  /// with v = 1 at the nodes on their walls and 0 at all others. By parts it is the integral of
  /// p n - du/dn over the walls, n out of the fluid, and more exact than that integral of discrete
  /// fields. The transposed half of the viscous stress adds nothing to it: along a wall u = 0, so
  /// that du_j/dx_i = n_i du_j/dn; then n_j du_j/dn = div u = 0, and n_j du_j/dx_i = 0. Source:
  /// V. John & G. Matthies, Int. J. Numer. Methods Fluids 37 (2001) 885. Where they touch a side of
  /// the lattice, the cells at the seam add their part of that side's force.
  Vector<dim> force_on_solids() const;
  /// Values over a side of the lattice, by its SideName.
  FlowSide side(int name) const;

  FlowPiece<dim> piece() const;

  struct Errors {
    double velocity = 0.0, pressure = 0.0;
  };
  /// 2-norms of the difference to given fields; pressures are compared less their means.
  Errors errors(const std::function<Vector<dim>(const Vector<dim>&)>& velocity,
                const std::function<double(const Vector<dim>&)>& pressure) const;

  struct Discrete;
  const Discrete& discrete() const { return *discrete_; }

 private:
  std::unique_ptr<Discrete> discrete_;
};

}  // namespace manoscope::navier_stokes
