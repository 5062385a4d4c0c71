// What is read off a solved flow: points, sections, errors.
#include <cmath>

#include "discrete_flow.hpp"
#include "manoscope/core/error.hpp"

namespace manoscope::navier_stokes {
namespace {

/// Points of a quadrature over one cell's section: unit place along x given, Gauss points across.
template <int dim>
dealii::Quadrature<dim> section_quadrature(double unit_x, unsigned int n) {
  const dealii::QGauss<dim - 1> across(n);
  std::vector<dealii::Point<dim>> points;
  for (unsigned int q = 0; q < across.size(); ++q) {
    dealii::Point<dim> point;
    point[0] = unit_x;
    for (int axis = 1; axis < dim; ++axis) point[axis] = across.point(q)[axis - 1];
    points.push_back(point);
  }
  return {points, across.get_weights()};
}

/// Shear stress along x on floor (t = 0) or roof (t = 1) from velocity slopes [axis](component) and
/// the wall's slope dy/dx, at a place with dy/dz = 0.
///
/// The wall stands still, so that only the slope along its normal counts: tau = t . (n . grad) u
/// with the tangent t = (1, y')/l and the normal n into the fluid.
template <int dim>
double wall_shear(const Eigen::Matrix<double, dim, dim>& slope, double wall_slope, bool is_roof) {
  const double length = std::hypot(1.0, wall_slope);
  Eigen::Matrix<double, dim, 1> tangent = Eigen::Matrix<double, dim, 1>::Zero();
  Eigen::Matrix<double, dim, 1> normal = Eigen::Matrix<double, dim, 1>::Zero();
  tangent(0) = 1.0 / length;
  tangent(1) = wall_slope / length;
  normal(0) = (is_roof ? 1.0 : -1.0) * wall_slope / length;
  normal(1) = (is_roof ? -1.0 : 1.0) / length;
  return normal.dot(slope * tangent);
}

template <int dim>
class SectionReader {
 public:
  using Discrete = typename FlowSolver<dim>::Discrete;

  SectionReader(const Discrete& discrete, int column, double unit_x)
      : discrete_(discrete), column_(column), unit_x_(unit_x) {
    for (int axis = 0; axis < dim; ++axis) {
      n_cells_[axis] = static_cast<int>(discrete.problem.edges[axis].size()) - 1;
    }
  }

  FlowSection read() {
    FlowSection section;
    read_area(section);
    for (const bool is_roof : {false, true}) read_wall(is_roof, section);
    return section;
  }

 private:
  CellPlace<dim> place(int up, int across) const {
    CellPlace<dim> result;
    result.n_cells = n_cells_;
    result.index[0] = column_;
    result.index[1] = up;
    if constexpr (dim == 3) result.index[2] = across;
    return result;
  }

  void read_area(FlowSection& section) const {
    const auto quadrature =
        section_quadrature<dim>(unit_x_, static_cast<unsigned int>(discrete_.problem.order) + 2);
    const auto flags = dealii::update_values | dealii::update_jacobians;
    dealii::FEValues<dim> of_velocity(discrete_.box.mapping, discrete_.velocity_element, quadrature,
                                      flags);
    dealii::FEValues<dim> of_pressure(discrete_.box.mapping, discrete_.pressure_element, quadrature,
                                      dealii::update_values);
    std::vector<typename Discrete::DofIndex> indices(discrete_.element.n_dofs_per_cell());
    double area = 0.0, force = 0.0;
    const int n_across = dim == 3 ? n_cells_[dim - 1] : 1;
    for (int up = 0; up < n_cells_[1]; ++up) {
      for (int across = 0; across < n_across; ++across) {
        const auto cell = place(up, across).cell(discrete_.dofs);
        cell->get_dof_indices(indices);
        const auto local = discrete_.local_state(indices);
        const typename dealii::Triangulation<dim>::cell_iterator plain_cell(cell);
        of_velocity.reinit(plain_cell);
        of_pressure.reinit(plain_cell);
        for (const unsigned int q : of_velocity.quadrature_point_indices()) {
          const auto& jacobian = of_velocity.jacobian(q);
          double part = quadrature.weight(q) * jacobian[1][1];
          if constexpr (dim == 3) part *= jacobian[2][2];  // z does not depend on t
          area += part;
          for (unsigned int k = 0; k < of_pressure.dofs_per_cell; ++k) {
            force += part * local.pressure(k) * of_pressure.shape_value(k, q);
          }
          for (unsigned int a = 0; a < of_velocity.dofs_per_cell; ++a) {
            section.flow += part * local.velocity(a, 0) * of_velocity.shape_value(a, q);
          }
        }
      }
    }
    section.mean_pressure = force / area;
  }

  void read_wall(bool is_roof, FlowSection& section) const {
    dealii::Point<dim> unit;
    unit[0] = unit_x_;
    unit[1] = is_roof ? 1.0 : 0.0;
    const dealii::Quadrature<dim> point(unit);
    dealii::FEValues<dim> values(discrete_.box.mapping, discrete_.velocity_element, point,
                                 dealii::update_gradients | dealii::update_jacobians);
    const auto cell = place(is_roof ? n_cells_[1] - 1 : 0, 0).cell(discrete_.dofs);
    std::vector<typename Discrete::DofIndex> indices(discrete_.element.n_dofs_per_cell());
    cell->get_dof_indices(indices);
    const auto local = discrete_.local_state(indices);
    values.reinit(typename dealii::Triangulation<dim>::cell_iterator(cell));
    Eigen::Matrix<double, dim, dim> slope = Eigen::Matrix<double, dim, dim>::Zero();
    for (unsigned int a = 0; a < values.dofs_per_cell; ++a) {
      for (int axis = 0; axis < dim; ++axis) {
        slope.row(axis) += values.shape_grad(a, 0)[axis] * local.velocity.row(a);
      }
    }
    double pressure = 0.0;
    for (unsigned int k = 0; k < discrete_.pressure_element.n_dofs_per_cell(); ++k) {
      pressure += local.pressure(k) * discrete_.pressure_element.shape_value(k, unit);
    }
    const auto& jacobian = values.jacobian(0);
    const double shear = wall_shear<dim>(slope, jacobian[1][0] / jacobian[0][0], is_roof);
    (is_roof ? section.roof_pressure : section.floor_pressure) = pressure;
    (is_roof ? section.roof_shear : section.floor_shear) = shear;
  }

  const Discrete& discrete_;
  int column_;
  double unit_x_;
  std::array<int, dim> n_cells_{};
};

FlowSection mean(const FlowSection& a, const FlowSection& b) {
  return {0.5 * (a.mean_pressure + b.mean_pressure),   0.5 * (a.roof_pressure + b.roof_pressure),
          0.5 * (a.floor_pressure + b.floor_pressure), 0.5 * (a.roof_shear + b.roof_shear),
          0.5 * (a.floor_shear + b.floor_shear),       0.5 * (a.flow + b.flow)};
}

}  // namespace

template <int dim>
FlowPoint<dim> FlowSolver<dim>::at(const Vector<dim>& box) const {
  const auto place = CellPlace<dim>::of(discrete_->problem.edges, box);
  const auto cell = place.cell(discrete_->dofs);
  std::vector<typename Discrete::DofIndex> indices(discrete_->element.n_dofs_per_cell());
  cell->get_dof_indices(indices);
  const auto local = discrete_->local_state(indices);
  const dealii::Point<dim> unit = place.unit_point();
  const auto real = discrete_->box.mapping.transform_unit_to_real_cell(cell, unit);
  FlowPoint<dim> point;
  for (int axis = 0; axis < dim; ++axis) point.place[axis] = real[axis];
  for (unsigned int a = 0; a < discrete_->velocity_element.n_dofs_per_cell(); ++a) {
    const double shape = discrete_->velocity_element.shape_value(a, unit);
    for (int c = 0; c < dim; ++c) point.velocity[c] += shape * local.velocity(a, c);
  }
  for (unsigned int k = 0; k < discrete_->pressure_element.n_dofs_per_cell(); ++k) {
    point.pressure += discrete_->pressure_element.shape_value(k, unit) * local.pressure(k);
  }
  return point;
}

template <int dim>
FlowSection FlowSolver<dim>::section(double x) const {
  Vector<dim> start{};
  start[0] = x;
  const auto place = CellPlace<dim>::of(discrete_->problem.edges, start);
  const FlowSection section = SectionReader<dim>(*discrete_, place.index[0], place.unit[0]).read();
  if (place.unit[0] > 0.0 || place.index[0] == 0) return section;
  return mean(section, SectionReader<dim>(*discrete_, place.index[0] - 1, 1.0).read());
}

template <int dim>
typename FlowSolver<dim>::Errors FlowSolver<dim>::errors(
    const std::function<Vector<dim>(const Vector<dim>&)>& velocity,
    const std::function<double(const Vector<dim>&)>& pressure) const {
  const dealii::QGauss<dim> quadrature(static_cast<unsigned int>(discrete_->problem.order) + 3);
  dealii::FEValues<dim> of_velocity(
      discrete_->box.mapping, discrete_->velocity_element, quadrature,
      dealii::update_values | dealii::update_JxW_values | dealii::update_quadrature_points);
  dealii::FEValues<dim> of_pressure(discrete_->box.mapping, discrete_->pressure_element, quadrature,
                                    dealii::update_values);
  std::vector<typename Discrete::DofIndex> indices(discrete_->element.n_dofs_per_cell());
  double volume = 0.0, u_square = 0.0, p_square = 0.0, p_sum = 0.0;
  for (const auto& cell : discrete_->dofs.active_cell_iterators()) {
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
  return {std::sqrt(u_square), std::sqrt(std::max(0.0, p_square - p_sum * p_sum / volume))};
}

template FlowPoint<2> FlowSolver<2>::at(const Vector<2>&) const;
template FlowPoint<3> FlowSolver<3>::at(const Vector<3>&) const;
template FlowSection FlowSolver<2>::section(double) const;
template FlowSection FlowSolver<3>::section(double) const;
template FlowSolver<2>::Errors FlowSolver<2>::errors(
    const std::function<Vector<2>(const Vector<2>&)>&,
    const std::function<double(const Vector<2>&)>&) const;
template FlowSolver<3>::Errors FlowSolver<3>::errors(
    const std::function<Vector<3>(const Vector<3>&)>&,
    const std::function<double(const Vector<3>&)>&) const;

}  // namespace manoscope::navier_stokes
