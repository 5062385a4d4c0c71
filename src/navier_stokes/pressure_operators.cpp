#include "pressure_operators.hpp"

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/sparsity_tools.h>

#include <set>

namespace manoscope::navier_stokes {

template <int dim>
PressureOperators<dim>::PressureOperators(const Discrete& discrete)
    : discrete_(discrete),
      open_(discrete.relevant),
      none_(discrete.relevant),
      face_quadrature_(static_cast<unsigned int>(discrete.problem.order) + 1),
      of_inflow_velocity_(
          discrete.mesh.mapping(), discrete.velocity_element, face_quadrature_,
          dealii::update_values | dealii::update_normal_vectors | dealii::update_JxW_values),
      of_inflow_pressure_(discrete.mesh.mapping(), discrete.pressure_element, face_quadrature_,
                          dealii::update_values) {
  std::set<dealii::types::boundary_id> open_sides;
  for (unsigned int side = 0; side < discrete.problem.sides.size(); ++side) {
    if (discrete.problem.sides[side].condition == SideCondition::open) open_sides.insert(side);
  }
  if (!open_sides.empty()) {
    const dealii::FEValuesExtractors::Scalar pressure(dim);
    for (const auto dof : dealii::DoFTools::extract_boundary_dofs(
             discrete.dofs, discrete.element.component_mask(pressure), open_sides)) {
      open_.add_line(dof);
    }
  }
  open_.close();
  none_.close();

  dealii::Table<2, dealii::DoFTools::Coupling> couplings(dim + 1, dim + 1);
  couplings.fill(dealii::DoFTools::none);
  couplings(dim, dim) = dealii::DoFTools::always;
  dealii::DynamicSparsityPattern pattern(discrete.relevant);
  dealii::DoFTools::make_sparsity_pattern(discrete.dofs, couplings, pattern, none_, true);
  const MPI_Comm comm = discrete.processes.comm();
  dealii::SparsityTools::distribute_sparsity_pattern(pattern, discrete.owned, comm,
                                                     discrete.relevant);
  for (Matrix* matrix : {&mass_, &stiffness_, &transport_}) {
    matrix->reinit(discrete.owned, discrete.owned, pattern, comm);
  }
}

/// 12/h^2 at the middle of a cell, h between the first and the last t.
template <int dim>
double PressureOperators<dim>::wall_drag(const CellIndex<dim>& index) const {
  const auto& edges = discrete_.mesh.edges();
  Vector<dim> low, high;
  for (int axis = 0; axis < dim; ++axis) {
    low[axis] = high[axis] = 0.5 * (edges[axis][index[axis]] + edges[axis][index[axis] + 1]);
  }
  low[1] = edges[1].front();
  high[1] = edges[1].back();
  const double gap = discrete_.problem.place(high)[1] - discrete_.problem.place(low)[1];
  return 12.0 / (gap * gap);
}

/// Adds Re (q, (-u . n) p) over a face where fluid enters.
template <int dim>
void PressureOperators<dim>::add_inflow(
    const typename dealii::Triangulation<dim>::cell_iterator& cell, unsigned int face,
    const typename Discrete::Local& local, double reynolds, dealii::FullMatrix<double>& transport) {
  of_inflow_velocity_.reinit(cell, face);
  of_inflow_pressure_.reinit(cell, face);
  for (const unsigned int q : of_inflow_velocity_.quadrature_point_indices()) {
    double outward = 0.0;
    for (unsigned int a = 0; a < of_inflow_velocity_.dofs_per_cell; ++a) {
      for (int c = 0; c < dim; ++c) {
        outward += of_inflow_velocity_.shape_value(a, q) * local.velocity(a, c) *
                   of_inflow_velocity_.normal_vector(q)[c];
      }
    }
    if (outward >= 0.0) continue;
    const double weight = -reynolds * outward * of_inflow_velocity_.JxW(q);
    for (unsigned int i = 0; i < of_inflow_pressure_.dofs_per_cell; ++i) {
      for (unsigned int j = 0; j < of_inflow_pressure_.dofs_per_cell; ++j) {
        transport(i, j) +=
            weight * of_inflow_pressure_.shape_value(i, q) * of_inflow_pressure_.shape_value(j, q);
      }
    }
  }
}

template <int dim>
void PressureOperators<dim>::assemble(double reynolds) {
  for (Matrix* matrix : {&mass_, &stiffness_, &transport_}) *matrix = 0.0;
  const dealii::QGauss<dim> quadrature(static_cast<unsigned int>(discrete_.problem.order) + 1);
  const auto& mapping = discrete_.mesh.mapping();
  dealii::FEValues<dim> of_velocity(mapping, discrete_.velocity_element, quadrature,
                                    dealii::update_values);
  dealii::FEValues<dim> of_pressure(
      mapping, discrete_.pressure_element, quadrature,
      dealii::update_values | dealii::update_gradients | dealii::update_JxW_values);
  const unsigned int n = discrete_.pressure_element.n_dofs_per_cell();
  std::vector<typename Discrete::DofIndex> indices(discrete_.element.n_dofs_per_cell()),
      pressures(n);
  dealii::FullMatrix<double> mass(n, n), stiffness(n, n), transport(n, n);
  for (const auto& cell : discrete_.dofs.active_cell_iterators()) {
    if (!cell->is_locally_owned()) continue;
    cell->get_dof_indices(indices);
    const auto local = discrete_.local_state(indices);
    for (unsigned int k = 0; k < n; ++k) {
      pressures[k] = indices[discrete_.element.component_to_system_index(dim, k)];
    }
    const typename dealii::Triangulation<dim>::cell_iterator plain_cell(cell);
    of_velocity.reinit(plain_cell);
    of_pressure.reinit(plain_cell);
    const double drag = wall_drag(discrete_.mesh.index_of(plain_cell));
    mass = stiffness = transport = 0.0;
    for (const unsigned int q : of_pressure.quadrature_point_indices()) {
      dealii::Tensor<1, dim> u;
      for (unsigned int a = 0; a < of_velocity.dofs_per_cell; ++a) {
        for (int c = 0; c < dim; ++c) u[c] += of_velocity.shape_value(a, q) * local.velocity(a, c);
      }
      const double weight = of_pressure.JxW(q);
      for (unsigned int i = 0; i < n; ++i) {
        const double q_i = weight * of_pressure.shape_value(i, q);
        for (unsigned int j = 0; j < n; ++j) {
          const double m = q_i * of_pressure.shape_value(j, q);
          const double s = weight * (of_pressure.shape_grad(i, q) * of_pressure.shape_grad(j, q));
          mass(i, j) += m;
          stiffness(i, j) += s;
          transport(i, j) += drag * m + reynolds * q_i * (u * of_pressure.shape_grad(j, q));
        }
      }
    }
    for (const unsigned int face : cell->face_indices()) {
      if (cell->face(face)->at_boundary()) add_inflow(plain_cell, face, local, reynolds, transport);
    }
    none_.distribute_local_to_global(mass, pressures, mass_);
    open_.distribute_local_to_global(stiffness, pressures, stiffness_);
    none_.distribute_local_to_global(transport, pressures, transport_);
  }
  for (Matrix* matrix : {&mass_, &stiffness_, &transport_}) {
    matrix->compress(dealii::VectorOperation::add);
  }
}

template class PressureOperators<2>;
template class PressureOperators<3>;

}  // namespace manoscope::navier_stokes
