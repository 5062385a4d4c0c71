// What is read off a solved flow: points, sides, pieces, errors.
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_values.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "discrete_flow.hpp"
#include "manoscope/core/error.hpp"

namespace manoscope::navier_stokes {

template <int dim>
FlowPoint<dim> FlowSolver<dim>::at(const Vector<dim>& chart) const {
  const auto located = discrete_->mesh.locate(chart);
  const auto cell = discrete_->mesh.own_cell(discrete_->dofs, located.index);
  std::vector<double> values(2 * dim + 2, 0.0);
  if (cell) {
    const FlowPoint<dim> point = discrete_->point(*cell, located.unit);
    std::copy(point.place.begin(), point.place.end(), values.begin());
    std::copy(point.velocity.begin(), point.velocity.end(), values.begin() + dim);
    values[2 * dim] = point.pressure;
    values[2 * dim + 1] = 1.0;
  }
  values = discrete_->processes.sum(values);
  MANO_ASSERT(values[2 * dim + 1] == 1.0);
  FlowPoint<dim> point;
  std::copy_n(values.begin(), dim, point.place.begin());
  std::copy_n(values.begin() + dim, dim, point.velocity.begin());
  point.pressure = values[2 * dim];
  return point;
}

template <int dim>
FlowSide FlowSolver<dim>::side(int name) const {
  const Discrete& discrete = *discrete_;
  const dealii::QGauss<dim - 1> quadrature(static_cast<unsigned int>(discrete.problem.order) + 2);
  dealii::FEFaceValues<dim> of_velocity(
      discrete.mesh.mapping(), discrete.velocity_element, quadrature,
      dealii::update_values | dealii::update_JxW_values | dealii::update_normal_vectors);
  dealii::FEFaceValues<dim> of_pressure(discrete.mesh.mapping(), discrete.pressure_element,
                                        quadrature, dealii::update_values);
  std::vector<typename Discrete::DofIndex> indices(discrete.element.n_dofs_per_cell());
  double area = 0.0, force = 0.0, flow = 0.0;
  for (const auto& cell : discrete.dofs.active_cell_iterators()) {
    if (!cell->is_locally_owned()) continue;
    const auto face = static_cast<unsigned int>(name);
    if (!cell->face(face)->at_boundary() ||
        static_cast<int>(cell->face(face)->boundary_id()) != name)
      continue;
    cell->get_dof_indices(indices);
    const auto local = discrete.local_state(indices);
    const typename dealii::Triangulation<dim>::cell_iterator plain_cell(cell);
    of_velocity.reinit(plain_cell, face);
    of_pressure.reinit(plain_cell, face);
    for (const unsigned int q : of_velocity.quadrature_point_indices()) {
      const double part = of_velocity.JxW(q);
      area += part;
      for (unsigned int k = 0; k < of_pressure.dofs_per_cell; ++k) {
        force += part * local.pressure(k) * of_pressure.shape_value(k, q);
      }
      for (unsigned int a = 0; a < of_velocity.dofs_per_cell; ++a) {
        for (int c = 0; c < dim; ++c) {
          flow += part * of_velocity.normal_vector(q)[c] * local.velocity(a, c) *
                  of_velocity.shape_value(a, q);
        }
      }
    }
  }
  const auto sums = discrete.processes.sum({area, force, flow});
  MANO_ASSERT(sums[0] > 0.0);
  return {sums[1] / sums[0], sums[2]};
}

template <int dim>
FlowPiece<dim> FlowSolver<dim>::piece() const {
  const Discrete& discrete = *discrete_;
  const int order = discrete.problem.order;
  FlowPiece<dim> piece;
  std::map<CellIndex<dim>, std::size_t> known;  // points of the finer lattice
  std::vector<CellIndex<dim>> steps(1 << dim);  // to the corners of a part
  for (int corner = 0; corner < 1 << dim; ++corner) {
    for (int axis = 0; axis < dim; ++axis) steps[corner][axis] = corner >> axis & 1;
  }
  for (const auto& cell : discrete.dofs.active_cell_iterators()) {
    if (!cell->is_locally_owned()) continue;
    const CellIndex<dim> index = discrete.mesh.index_of(cell);
    const auto number_of = [&](const CellIndex<dim>& part) {
      CellIndex<dim> fine;
      dealii::Point<dim> unit;
      for (int axis = 0; axis < dim; ++axis) {
        fine[axis] = index[axis] * order + part[axis];
        unit[axis] = static_cast<double>(part[axis]) / order;
      }
      const auto [at, is_new] = known.emplace(fine, piece.points.size());
      if (is_new) piece.points.push_back(discrete.point(cell, unit));
      return at->second;
    };
    int n_parts = 1;
    for (int axis = 0; axis < dim; ++axis) n_parts *= order;
    for (int part = 0; part < n_parts; ++part) {
      CellIndex<dim> low;
      for (int axis = 0, rest = part; axis < dim; ++axis, rest /= order) low[axis] = rest % order;
      piece.cells.emplace_back();
      for (int corner = 0; corner < 1 << dim; ++corner) {
        CellIndex<dim> at = low;
        for (int axis = 0; axis < dim; ++axis) at[axis] += steps[corner][axis];
        piece.cells.back()[corner] = number_of(at);
      }
    }
  }
  return piece;
}

template <int dim>
typename FlowSolver<dim>::Errors FlowSolver<dim>::errors(
    const std::function<Vector<dim>(const Vector<dim>&)>& velocity,
    const std::function<double(const Vector<dim>&)>& pressure) const {
  const dealii::QGauss<dim> quadrature(static_cast<unsigned int>(discrete_->problem.order) + 3);
  dealii::FEValues<dim> of_velocity(
      discrete_->mesh.mapping(), discrete_->velocity_element, quadrature,
      dealii::update_values | dealii::update_JxW_values | dealii::update_quadrature_points);
  dealii::FEValues<dim> of_pressure(discrete_->mesh.mapping(), discrete_->pressure_element,
                                    quadrature, dealii::update_values);
  std::vector<typename Discrete::DofIndex> indices(discrete_->element.n_dofs_per_cell());
  double volume = 0.0, u_square = 0.0, p_square = 0.0, p_sum = 0.0;
  for (const auto& cell : discrete_->dofs.active_cell_iterators()) {
    if (!cell->is_locally_owned()) continue;
    cell->get_dof_indices(indices);
    const auto local = discrete_->local_state(indices);
    const typename dealii::Triangulation<dim>::cell_iterator plain_cell(cell);
    of_velocity.reinit(plain_cell);
    of_pressure.reinit(plain_cell);
    for (const unsigned int q : of_velocity.quadrature_point_indices()) {
      Vector<dim> place;
      for (int axis = 0; axis < dim; ++axis) place[axis] = of_velocity.quadrature_point(q)[axis];
      const double weight = of_velocity.JxW(q);
      const Vector<dim> exact = velocity(place);
      for (int c = 0; c < dim; ++c) {
        double u = -exact[c];
        for (unsigned int a = 0; a < of_velocity.dofs_per_cell; ++a) {
          u += of_velocity.shape_value(a, q) * local.velocity(a, c);
        }
        u_square += weight * u * u;
      }
      double p = -pressure(place);
      for (unsigned int k = 0; k < of_pressure.dofs_per_cell; ++k) {
        p += of_pressure.shape_value(k, q) * local.pressure(k);
      }
      volume += weight;
      p_sum += weight * p;
      p_square += weight * p * p;
    }
  }
  const auto sums = discrete_->processes.sum({volume, u_square, p_square, p_sum});
  return {std::sqrt(sums[1]), std::sqrt(std::max(0.0, sums[2] - sums[3] * sums[3] / sums[0]))};
}

template FlowPoint<2> FlowSolver<2>::at(const Vector<2>&) const;
template FlowPoint<3> FlowSolver<3>::at(const Vector<3>&) const;
template FlowSide FlowSolver<2>::side(int) const;
template FlowSide FlowSolver<3>::side(int) const;
template FlowPiece<2> FlowSolver<2>::piece() const;
template FlowPiece<3> FlowSolver<3>::piece() const;
template FlowSolver<2>::Errors FlowSolver<2>::errors(
    const std::function<Vector<2>(const Vector<2>&)>&,
    const std::function<double(const Vector<2>&)>&) const;
template FlowSolver<3>::Errors FlowSolver<3>::errors(
    const std::function<Vector<3>(const Vector<3>&)>&,
    const std::function<double(const Vector<3>&)>&) const;

}  // namespace manoscope::navier_stokes
