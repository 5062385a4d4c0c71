#include "flow_solver.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <deal.II/dofs/dof_tools.h>

#include "block_solver.hpp"
#include "checkpoint.hpp"
#include "discrete_flow.hpp"
#include "flow_assembly.hpp"
#include "manoscope/core/error.hpp"
#include "pressure_operators.hpp"

namespace manoscope::navier_stokes {
namespace {

constexpr const char* kWhere = "Navier-Stokes solver";

/// Weight of the grad-div term for the iterative solver: Krylov steps of a channel at Re = 690,
/// 0.03: 105, 0.1: 62.
constexpr double kIterativeGradDiv = 0.1;
constexpr double kInfinite = std::numeric_limits<double>::infinity();

template <int dim>
void check(const FlowProblem<dim>& problem) {
  constexpr int kLeastOrder = 2, kLargestOrder = 4;
  if (problem.order < kLeastOrder || problem.order > kLargestOrder) {
    throw InputError(kWhere, fmt::format("elements of order {}", problem.order),
                     fmt::format("Choose an order from {} to {}", kLeastOrder, kLargestOrder));
  }
  for (const std::vector<double>& edges : problem.edges) {
    const bool ascending =
        std::adjacent_find(edges.begin(), edges.end(), std::greater_equal<>()) == edges.end();
    if (edges.size() >= 2 && ascending) continue;
    throw InputError(kWhere, "the edges of the cells do not ascend",
                     "Give at least one cell along each axis, and distinct positions");
  }
}

/// Newton's iteration on one problem.
template <int dim>
class Newton {
 public:
  using Discrete = typename FlowSolver<dim>::Discrete;
  using State = typename Discrete::State;

  Newton(Discrete& discrete, const Monitor& monitor, std::filesystem::path checkpoint)
      : discrete_(discrete),
        monitor_(monitor),
        checkpoint_(std::move(checkpoint)),
        given_(find_given_values<dim>(discrete)),
        assembler_(discrete, given_.fixed),
        change_(discrete.owned, discrete.processes.comm()),
        is_pressure_(discrete.owned.n_elements(), 0) {
    for (const int dof : assembler_.blocks().pressure) {
      is_pressure_[discrete.owned.index_within_set(dof)] = 1;
    }
    discrete.costs.n_unknowns = assembler_.n_unknowns();
    const MPI_Comm comm = discrete.processes.comm();
    if (discrete.problem.solver == SolverKind::iterative) {
      auto blocks = std::make_unique<BlockSolver>(comm, assembler_.blocks());
      blocks_ = blocks.get();
      solver_ = std::move(blocks);
      pressure_operators_.emplace(discrete);
    } else {
      solver_ = direct_solver(comm);
    }
    const double least = blocks_ != nullptr ? kIterativeGradDiv : 0.0;
    set_grad_div(std::max(least, discrete.problem.grad_div));
  }

  /// Raises the weight of the grad-div term to kGradDiv, if it is below.
  void need_grad_div() { set_grad_div(std::max(assembler_.grad_div(), kGradDiv)); }

  /// @return whether the problem's own start leads to its flow.
  bool starts_near() {
    const auto& mesh = discrete_.mesh;
    State& state = discrete_.state;
    state = given_.value;
    std::vector<typename Discrete::DofIndex> indices(discrete_.element.n_dofs_per_cell());
    for (const auto& cell : discrete_.dofs.active_cell_iterators()) {
      if (!cell->is_locally_owned()) continue;
      cell->get_dof_indices(indices);
      for (unsigned int i = 0; i < indices.size(); ++i) {
        const auto component = discrete_.element.system_to_component_index(i).first;
        if (component == dim || !discrete_.owned.is_element(indices[i])) continue;
        if (given_.fixed.is_constrained(indices[i])) continue;
        const auto chart = mesh.chart(cell, discrete_.element.unit_support_point(i));
        state(indices[i]) = discrete_.problem.start(chart)[component];
      }
    }
    state.update_ghost_values();
    return converges(discrete_.problem.reynolds);
  }

  /// Goes from Stokes flow to the Reynolds number in steps that halve where the iteration fails;
  /// @return the share that is reached before they are smaller than `least_step`.
  double follow(double least_step) {
    discrete_.state = given_.value;
    reached_ = 0.0;
    return converges(0.0) ? raise(least_step) : 0.0;
  }

  /// Goes on from the checkpoint, where there is one.
  double resume(double least_step) {
    const auto progress = read_checkpoint<dim>(checkpoint_, discrete_);
    if (!progress) return 0.0;
    if (progress->grad_div && !discrete_.costs.grad_div) need_grad_div();
    reached_ = progress->reached;
    return raise(least_step);
  }

 private:
  void set_grad_div(double weight) {
    assembler_.set_grad_div(weight);
    discrete_.grad_div = weight;
    discrete_.costs.grad_div = weight != 0.0;
  }

  double raise(double least_step) {
    double step = 1.0;
    while (reached_ < 1.0 && step >= least_step && discrete_.problem.reynolds > 0.0) {
      const double target = std::min(1.0, reached_ + step);
      const State before = discrete_.state;
      if (converges(target * discrete_.problem.reynolds)) {
        reached_ = target;
        continue;
      }
      discrete_.state = before;
      step /= 2.0;
    }
    return discrete_.problem.reynolds > 0.0 ? reached_ : 1.0;
  }

  /// @return false if the iteration does not converge; the state is then of no use.
  bool converges(double reynolds) {
    constexpr int kMostSteps = 12;
    // Each step is about the square of the last: their ratios foretell the next, which is not taken
    // where it would be too small to matter.
    constexpr double kSmall = 1e-8, kNextSmall = 1e-9, kLost = 1e3;
    constexpr int kWandering = 5;  // steps by which a start that leads anywhere has come near
    double before = kLost;
    for (int i = 0; i < kMostSteps; ++i) {
      const double change = step(reynolds);
      if (!std::isfinite(change)) return false;
      if (reynolds == 0.0 || change <= kSmall) return true;  // Stokes flow is linear
      const double ratio = change / before;
      if (i > 0 && change * ratio * ratio <= kNextSmall) return true;
      if (change >= kLost || (i >= kWandering && change > 0.5 * before)) return false;
      before = change;
    }
    return false;
  }

  /// One step; @return the larger of its parts in u and p, each of the largest value; infinity if
  /// its linear system has no solution that counts.
  double step(double reynolds) {
    together(discrete_.processes.comm(), [&] { monitor_.checkpoint(); });
    assembler_.assemble(reynolds);
    if (pressure_operators_) {
      pressure_operators_->assemble(reynolds);
      blocks_->set_pressure_operators(pressure_operators_->mass(), pressure_operators_->stiffness(),
                                      pressure_operators_->transport(),
                                      assembler_.grad_div() * reynolds);
    }
    const bool solved = solver_->solve(assembler_.matrix(), assembler_.right(), change_);
    FlowCosts& costs = discrete_.costs;
    costs.n_iterations += solver_->n_iterations();
    ++costs.n_newton_steps;
    if (!solved) return kInfinite;
    costs.largest_residual = std::max(costs.largest_residual, solver_->residual());
    const double moved = take(change_);
    if (!checkpoint_.empty()) {
      write_checkpoint<dim>(checkpoint_, discrete_, {reached_, costs.grad_div});
    }
    return moved;
  }

  double take(const dealii::PETScWrappers::MPI::Vector& change) {
    std::array<double, 2> largest_change{}, largest_value{};
    State& state = discrete_.state;
    unsigned int i = 0;
    state.zero_out_ghost_values();
    for (const auto dof : discrete_.owned) {
      const double moved = change(dof);
      double& value = state.local_element(i);
      value += moved;
      const int part = is_pressure_[i++];
      largest_value[part] = std::max(largest_value[part], std::abs(value));
      // max() would lose a NaN, and a step that is none must not pass for a small one.
      const double size = std::isnan(moved) ? kInfinite : std::abs(moved);
      largest_change[part] = std::max(largest_change[part], size);
    }
    state.update_ghost_values();
    double result = 0.0;
    for (int part = 0; part < 2; ++part) {
      const double size = discrete_.processes.largest(largest_value[part]);
      const double moved = discrete_.processes.largest(largest_change[part]);
      if (moved > 0.0) result = std::max(result, moved / size);
    }
    return result;
  }

  Discrete& discrete_;
  const Monitor& monitor_;
  std::filesystem::path checkpoint_;
  double reached_ = 0.0;  ///< share of the Reynolds number at which the iteration came to rest
  GivenValues<dim> given_;
  FlowAssembler<dim> assembler_;
  std::unique_ptr<LinearSolver> solver_;
  BlockSolver* blocks_ = nullptr;  ///< solver_, where it is one
  std::optional<PressureOperators<dim>> pressure_operators_;
  dealii::PETScWrappers::MPI::Vector change_;
  std::vector<unsigned char> is_pressure_;  ///< (owned)
};

}  // namespace

template <int dim>
FlowSolver<dim>::Discrete::Discrete(const FlowProblem<dim>& given)
    : problem(given),
      mesh(processes.comm(), {given.edges, given.solid, given.place}, given.order),
      velocity_element(given.order),
      pressure_element(given.order - 1),
      element(velocity_element, dim, pressure_element, 1),
      dofs(mesh.triangulation()) {
  dofs.distribute_dofs(element);
  owned = dofs.locally_owned_dofs();
  dealii::DoFTools::extract_locally_relevant_dofs(dofs, relevant);
  state = zero_state();
}

template <int dim>
FlowSolver<dim>::FlowSolver(const FlowProblem<dim>& problem) {
  check(problem);
  discrete_ = std::make_unique<Discrete>(problem);
}

template <int dim>
FlowSolver<dim>::~FlowSolver() = default;
template <int dim>
FlowSolver<dim>::FlowSolver(FlowSolver&&) noexcept = default;

template <int dim>
void FlowSolver<dim>::solve(const Monitor& monitor, const std::filesystem::path& checkpoint) {
  Newton<dim> newton(*discrete_, monitor, checkpoint);
  constexpr double kAtOnce = 1.0, kLeastStep = 1.0 / 64.0;
  if (!checkpoint.empty() && newton.resume(kLeastStep) == 1.0) return;
  const bool near = discrete_->problem.start != nullptr;
  if (near ? newton.starts_near() : newton.follow(kAtOnce) == 1.0) return;
  newton.need_grad_div();
  const double reached = newton.follow(kLeastStep);
  if (reached == 1.0) return;
  const bool iterative = discrete_->problem.solver == SolverKind::iterative;
  throw InputError(kWhere,
                   fmt::format("no steady flow is found beyond Re = {:.4g}, where Re = {:.4g} is "
                               "asked for",
                               reached * discrete_->problem.reynolds, discrete_->problem.reynolds),
                   fmt::format("Take more cells{}; where that does not help, the flow separates "
                               "or is unsteady there: lower the flow rate",
                               iterative ? ", or --solver direct" : ""));
}

template <int dim>
const FlowCosts& FlowSolver<dim>::costs() const {
  return discrete_->costs;
}

template class FlowSolver<2>;
template class FlowSolver<3>;

}  // namespace manoscope::navier_stokes
