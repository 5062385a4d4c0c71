#pragma once

#include <deal.II/base/point.h>
#include <deal.II/dofs/dof_handler.h>

#include <algorithm>
#include <array>
#include <vector>

namespace manoscope::navier_stokes {

/// Where a point of the box (x, t[, z]) lies: number of the cell along each axis, and the place in
/// it from 0 to 1.
template <int dim>
struct CellPlace {
  std::array<int, dim> index{};
  std::array<double, dim> unit{};
  std::array<int, dim> n_cells{};

  /// The cell to the right, or upper, where the point is an edge, except at the last edge.
  static CellPlace of(const std::array<std::vector<double>, dim>& edges,
                      const std::array<double, dim>& point) {
    CellPlace place;
    for (int axis = 0; axis < dim; ++axis) {
      const std::vector<double>& e = edges[axis];
      const auto above = std::upper_bound(e.begin(), e.end(), point[axis]);
      place.n_cells[axis] = static_cast<int>(e.size()) - 1;
      place.index[axis] =
          std::clamp(static_cast<int>(above - e.begin()) - 1, 0, place.n_cells[axis] - 1);
      const double low = e[place.index[axis]], high = e[place.index[axis] + 1];
      place.unit[axis] = std::clamp((point[axis] - low) / (high - low), 0.0, 1.0);
    }
    return place;
  }

  dealii::Point<dim> unit_point() const {
    dealii::Point<dim> point;
    for (int axis = 0; axis < dim; ++axis) point[axis] = unit[axis];
    return point;
  }

  /// The cell of a MappedBox's triangulation, whose numbers run along x first.
  typename dealii::DoFHandler<dim>::active_cell_iterator cell(
      const dealii::DoFHandler<dim>& dofs) const {
    int number = index[dim - 1];
    for (int axis = dim - 2; axis >= 0; --axis) number = number * n_cells[axis] + index[axis];
    return {&dofs.get_triangulation(), 0, number, &dofs};
  }
};

}  // namespace manoscope::navier_stokes
