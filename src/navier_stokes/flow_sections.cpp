// Sections of a solved flow: means over them, and pressure and shear on floor and roof.
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_values.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

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

/// Reads one section of a column of cells that belongs to this process.
template <int dim>
class SectionReader {
 public:
  using Discrete = typename FlowSolver<dim>::Discrete;

  SectionReader(const Discrete& discrete, int column, double unit_x)
      : discrete_(discrete),
        column_(column),
        unit_x_(unit_x),
        indices_(discrete.element.n_dofs_per_cell()) {}

  FlowSection read() {
    FlowSection section;
    read_area(section);
    for (const bool is_roof : {false, true}) read_wall(is_roof, section);
    return section;
  }

 private:
  void read_area(FlowSection& section) {
    const auto quadrature =
        section_quadrature<dim>(unit_x_, static_cast<unsigned int>(discrete_.problem.order) + 2);
    const auto flags = dealii::update_values | dealii::update_jacobians;
    const auto& mapping = discrete_.mesh.mapping();
    dealii::FEValues<dim> of_velocity(mapping, discrete_.velocity_element, quadrature, flags);
    dealii::FEValues<dim> of_pressure(mapping, discrete_.pressure_element, quadrature,
                                      dealii::update_values);
    double area = 0.0, force = 0.0;
    const int n_across = dim == 3 ? discrete_.mesh.n_cells(dim - 1) : 1;
    for (int up = 0; up < discrete_.mesh.n_cells(1); ++up) {
      for (int across = 0; across < n_across; ++across) {
        const auto cell = discrete_.mesh.own_cell(discrete_.dofs, index(up, across));
        if (!cell) continue;  // solid
        (*cell)->get_dof_indices(indices_);
        const auto local = discrete_.local_state(indices_);
        const typename dealii::Triangulation<dim>::cell_iterator plain_cell(*cell);
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

  void read_wall(bool is_roof, FlowSection& section) {
    // Middle of the first cell beside the wall, at z = 0 from above.
    std::array<double, dim> beside{};
    beside[0] = discrete_.mesh.edges()[0][column_];
    beside[1] = is_roof ? std::nextafter(1.0, 0.0) : 0.0;
    auto located = discrete_.mesh.locate(beside);
    located.index[0] = column_;
    located.unit[0] = unit_x_;
    located.unit[1] = is_roof ? 1.0 : 0.0;
    const auto cell = discrete_.mesh.own_cell(discrete_.dofs, located.index);
    if (!cell) return;
    const dealii::Quadrature<dim> point(located.unit);
    dealii::FEValues<dim> values(discrete_.mesh.mapping(), discrete_.velocity_element, point,
                                 dealii::update_gradients | dealii::update_jacobians);
    (*cell)->get_dof_indices(indices_);
    const auto local = discrete_.local_state(indices_);
    values.reinit(typename dealii::Triangulation<dim>::cell_iterator(*cell));
    Eigen::Matrix<double, dim, dim> slope = Eigen::Matrix<double, dim, dim>::Zero();
    for (unsigned int a = 0; a < values.dofs_per_cell; ++a) {
      for (int axis = 0; axis < dim; ++axis) {
        slope.row(axis) += values.shape_grad(a, 0)[axis] * local.velocity.row(a);
      }
    }
    const auto& jacobian = values.jacobian(0);
    (is_roof ? section.roof_pressure : section.floor_pressure) =
        discrete_.point(*cell, located.unit).pressure;
    (is_roof ? section.roof_shear : section.floor_shear) =
        wall_shear<dim>(slope, jacobian[1][0] / jacobian[0][0], is_roof);
  }

  CellIndex<dim> index(int up, int across) const {
    CellIndex<dim> result{column_, up};
    if constexpr (dim == 3) result[2] = across;
    return result;
  }

  const Discrete& discrete_;
  int column_;
  double unit_x_;
  std::vector<typename Discrete::DofIndex> indices_;
};

using SectionValues = std::array<double, 6>;

SectionValues values_of(const FlowSection& section) {
  return {section.mean_pressure, section.roof_pressure, section.floor_pressure,
          section.roof_shear,    section.floor_shear,   section.flow};
}

FlowSection section_of(const double* v) { return {v[0], v[1], v[2], v[3], v[4], v[5]}; }

}  // namespace

template <int dim>
std::vector<FlowSection> FlowSolver<dim>::sections(const std::vector<double>& x) const {
  constexpr std::size_t kSize = std::tuple_size_v<SectionValues>;
  std::vector<double> values(kSize * x.size(), 0.0);
  const auto [first, last] = discrete_->mesh.own_columns();
  const auto add = [&, first = first, last = last](std::size_t i, int column, double unit_x,
                                                   double weight) {
    if (column < first || column >= last) return;
    const auto part = values_of(SectionReader<dim>(*discrete_, column, unit_x).read());
    for (std::size_t k = 0; k < kSize; ++k) values[kSize * i + k] += weight * part[k];
  };
  for (std::size_t i = 0; i < x.size(); ++i) {
    Vector<dim> start{};
    start[0] = x[i];
    const auto located = discrete_->mesh.locate(start);
    const bool is_edge = located.unit[0] == 0.0 && located.index[0] > 0;
    add(i, located.index[0], located.unit[0], is_edge ? 0.5 : 1.0);
    if (is_edge) add(i, located.index[0] - 1, 1.0, 0.5);
  }
  values = discrete_->processes.sum(values);
  std::vector<FlowSection> result;
  for (std::size_t i = 0; i < x.size(); ++i) result.push_back(section_of(&values[kSize * i]));
  return result;
}

template std::vector<FlowSection> FlowSolver<2>::sections(const std::vector<double>&) const;
template std::vector<FlowSection> FlowSolver<3>::sections(const std::vector<double>&) const;

}  // namespace manoscope::navier_stokes
