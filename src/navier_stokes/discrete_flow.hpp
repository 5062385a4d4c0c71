#pragma once

#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/lac/la_parallel_vector.h>

#include <Eigen/Core>
#include <vector>

#include "flow_solver.hpp"
#include "lattice_mesh.hpp"
#include "processes.hpp"

namespace manoscope::navier_stokes {

/// A FlowProblem on its mesh, and its solution: the part of this process.
template <int dim>
struct FlowSolver<dim>::Discrete {
  using DofIndex = dealii::types::global_dof_index;
  /// One value a degree of freedom: its own, and those of cells next to them.
  using State = dealii::LinearAlgebra::distributed::Vector<double>;

  explicit Discrete(const FlowProblem<dim>& given);

  State zero_state() const { return {owned, relevant, processes.comm()}; }

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

  /// Values at the unit place of a cell of this process.
  template <class Cell>
  FlowPoint<dim> point(const Cell& cell, const dealii::Point<dim>& unit) const {
    std::vector<DofIndex> indices(element.n_dofs_per_cell());
    cell->get_dof_indices(indices);
    const Local local = local_state(indices);
    const dealii::Point<dim> place = mesh.mapping().transform_unit_to_real_cell(cell, unit);
    FlowPoint<dim> point;
    for (int axis = 0; axis < dim; ++axis) point.place[axis] = place[axis];
    for (unsigned int a = 0; a < velocity_element.n_dofs_per_cell(); ++a) {
      const double shape = velocity_element.shape_value(a, unit);
      for (int c = 0; c < dim; ++c) point.velocity[c] += shape * local.velocity(a, c);
    }
    for (unsigned int k = 0; k < pressure_element.n_dofs_per_cell(); ++k) {
      point.pressure += pressure_element.shape_value(k, unit) * local.pressure(k);
    }
    return point;
  }

  const Processes& processes = Processes::all();
  FlowProblem<dim> problem;
  LatticeMesh<dim> mesh;
  dealii::FE_Q<dim> velocity_element, pressure_element;
  dealii::FESystem<dim> element;
  dealii::DoFHandler<dim> dofs;
  dealii::IndexSet owned, relevant;
  State state;
  double grad_div = 0.0;  ///< weight of the grad-div term over the Reynolds number
  FlowCosts costs;
};

}  // namespace manoscope::navier_stokes
