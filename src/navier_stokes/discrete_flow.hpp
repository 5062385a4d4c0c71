#pragma once

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/fe_values.h>

#include <vector>

#include "cell_place.hpp"
#include "dof_pattern.hpp"
#include "flow_solver.hpp"
#include "mapped_box.hpp"

namespace manoscope::navier_stokes {

/// A FlowProblem on its mesh, and its solution.
template <int dim>
struct FlowSolver<dim>::Discrete {
  using DofIndex = dealii::types::global_dof_index;

  explicit Discrete(const FlowProblem<dim>& given)
      : problem(given),
        box(problem.edges, problem.gap, problem.order),
        velocity_element(problem.order),
        pressure_element(problem.order - 1),
        element(velocity_element, dim, pressure_element, 1),
        dofs(box.triangulation) {
    dofs.distribute_dofs(element);
    state.assign(dofs.n_dofs(), 0.0);
  }

  /// Velocities (node, component) and pressures (node) of a cell.
  struct Local {
    Eigen::Matrix<double, Eigen::Dynamic, dim> velocity;
    Eigen::VectorXd pressure;
  };
  Local local_state(const std::vector<DofIndex>& indices) const {
    Local local{{velocity_element.n_dofs_per_cell(), dim}, {}};
    local.pressure.resize(pressure_element.n_dofs_per_cell());
    for (unsigned int i = 0; i < indices.size(); ++i) {
      const auto [component, node] = element.system_to_component_index(i);
      (component < dim ? local.velocity(node, component) : local.pressure(node)) =
          state[indices[i]];
    }
    return local;
  }

  FlowProblem<dim> problem;
  MappedBox<dim> box;
  dealii::FE_Q<dim> velocity_element, pressure_element;
  dealii::FESystem<dim> element;
  dealii::DoFHandler<dim> dofs;
  std::vector<double> state;  ///< one a degree of freedom
  int n_unknowns = 0;
  int n_newton_steps = 0;
  double largest_residual = 0.0;
};

}  // namespace manoscope::navier_stokes
