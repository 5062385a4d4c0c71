// What is read off a solved flow: points, sections, errors.
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_values.h>

#include <algorithm>
#include <cmath>
#include <map>
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
template std::vector<FlowSection> FlowSolver<2>::sections(const std::vector<double>&) const;
template std::vector<FlowSection> FlowSolver<3>::sections(const std::vector<double>&) const;
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
