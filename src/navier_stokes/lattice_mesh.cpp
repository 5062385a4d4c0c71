#include "lattice_mesh.hpp"

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_nothing.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/grid/tria_description.h>
#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <mutex>

#include "manoscope/core/error.hpp"
#include "processes.hpp"

namespace manoscope::navier_stokes {
namespace {

constexpr const char* kWhere = "mesh of the flow";

/// Keeps, of the exceptions that several threads meet, that of the lowest place.
template <class Place>
class FirstFault {
 public:
  template <class Work>
  void watch(const Place& place, const Work& work) {
    try {
      work();
    } catch (...) {
      const std::lock_guard lock(mutex_);
      if (fault_ && !(place < place_)) return;
      fault_ = std::current_exception();
      place_ = place;
    }
  }
  void rethrow() const {
    if (fault_) std::rethrow_exception(fault_);
  }

 private:
  std::mutex mutex_;
  std::exception_ptr fault_;
  Place place_{};
};

/// Visits every index from `low` to before `high`, the last axis fastest.
template <int dim, class Visit>
void for_box(const CellIndex<dim>& low, const CellIndex<dim>& high, const Visit& visit) {
  for (int axis = 0; axis < dim; ++axis) {
    if (low[axis] >= high[axis]) return;
  }
  CellIndex<dim> index = low;
  while (true) {
    visit(index);
    int axis = dim - 1;
    while (axis >= 0 && ++index[axis] == high[axis]) {
      index[axis] = low[axis];
      --axis;
    }
    if (axis < 0) return;
  }
}

/// Number of an index in the box from `low` to before `high`.
template <int dim>
std::size_t number_in(const CellIndex<dim>& low, const CellIndex<dim>& high,
                      const CellIndex<dim>& index) {
  std::size_t number = 0;
  for (int axis = 0; axis < dim; ++axis) {
    number = number * static_cast<std::size_t>(high[axis] - low[axis]) +
             static_cast<std::size_t>(index[axis] - low[axis]);
  }
  return number;
}

}  // namespace

template <int dim>
LatticeMesh<dim>::LatticeMesh(MPI_Comm comm, const Shape& shape, int degree)
    : edges_(shape.edges), triangulation_(comm), mapping_(degree) {
  deal_out(comm, shape);
  build(comm, shape);
  together(comm, [&] {
    map(shape);
    check_cells();
  });
}

/// Finds where the cells stand.
template <int dim>
void LatticeMesh<dim>::map(const Shape& shape) {
  // deal.II asks from several threads, and ends the program if an exception leaves one of them.
  FirstFault<Point> fault;
  mapping_.initialize(
      dealii::MappingQ<dim>(1), triangulation_,
      [&](const auto&, const dealii::Point<dim>& chart) {
        Point from;
        for (int axis = 0; axis < dim; ++axis) from[axis] = chart[axis];
        dealii::Point<dim> place = chart;
        fault.watch(from, [&] {
          const Point to = shape.place(from);
          for (int axis = 0; axis < dim; ++axis) place[axis] = to[axis];
        });
        return place;
      },
      false);
  fault.rethrow();
}

template <int dim>
bool LatticeMesh<dim>::is_fluid(const Shape& shape, const CellIndex<dim>& index) const {
  Point centre;
  for (int axis = 0; axis < dim; ++axis) {
    if (index[axis] < 0 || index[axis] >= n_cells(axis)) return false;
    centre[axis] = 0.5 * (edges_[axis][index[axis]] + edges_[axis][index[axis] + 1]);
  }
  return !shape.solid || !shape.solid(centre);
}

template <int dim>
std::int64_t LatticeMesh<dim>::number(const CellIndex<dim>& index) const {
  CellIndex<dim> high;
  for (int axis = 0; axis < dim; ++axis) high[axis] = n_cells(axis);
  return static_cast<std::int64_t>(number_in<dim>({}, high, index));
}

/// Gives every process columns with about the same number of cells.
template <int dim>
void LatticeMesh<dim>::deal_out(MPI_Comm comm, const Shape& shape) {
  int rank = 0, size = 1;
  MPI_Comm_rank(comm, &rank);
  MPI_Comm_size(comm, &size);
  const int n_columns = n_cells(0);
  std::vector<std::int64_t> before(1, 0);  // cells left of a column
  for (int column = 0; column < n_columns; ++column) {
    CellIndex<dim> low{}, high;
    for (int axis = 0; axis < dim; ++axis) high[axis] = n_cells(axis);
    low[0] = column;
    high[0] = column + 1;
    std::int64_t n = 0;
    for_box<dim>(low, high, [&](const auto& index) { n += is_fluid(shape, index) ? 1 : 0; });
    before.push_back(before.back() + n);
  }
  if (before.back() == 0 || n_columns < size) {
    throw InputError(kWhere,
                     fmt::format("{} columns of cells with {} cells in all, for {} processes",
                                 n_columns, before.back(), size),
                     "Take more cells along the channel, or fewer processes");
  }
  first_of_rank_.assign(1, 0);
  for (int r = 1; r <= size; ++r) {
    const std::int64_t wanted = before.back() * r / size;
    const auto at = std::lower_bound(before.begin(), before.end(), wanted) - before.begin();
    const int least = first_of_rank_.back() + 1, most = n_columns - (size - r);
    first_of_rank_.push_back(std::clamp(static_cast<int>(at), least, most));
  }
  own_ = {first_of_rank_[rank], first_of_rank_[rank + 1]};
  held_ = {std::max(0, own_[0] - 1), std::min(n_columns, own_[1] + 1)};
}

/// The triangulation of the columns that this process holds.
template <int dim>
void LatticeMesh<dim>::build(MPI_Comm comm, const Shape& shape) {
  CellIndex<dim> low{}, high, last;
  for (int axis = 0; axis < dim; ++axis) {
    high[axis] = n_cells(axis);
    last[axis] = high[axis] + 1;  // of the lattice's points
  }
  low[0] = held_[0];
  high[0] = held_[1];
  last[0] = held_[1] + 1;

  dealii::TriangulationDescription::Description<dim, dim> description;
  description.comm = comm;
  description.settings = dealii::TriangulationDescription::Settings::default_setting;
  description.smoothing = dealii::Triangulation<dim>::none;
  description.cell_infos.resize(1);
  std::vector<int> vertex(number_in<dim>(low, last, last), -1);
  const auto vertex_of = [&](const CellIndex<dim>& point) {
    int& found = vertex[number_in<dim>(low, last, point)];
    if (found < 0) {
      found = static_cast<int>(description.coarse_cell_vertices.size());
      dealii::Point<dim> chart;
      for (int axis = 0; axis < dim; ++axis) chart[axis] = edges_[axis][point[axis]];
      description.coarse_cell_vertices.push_back(chart);
    }
    return static_cast<unsigned int>(found);
  };
  triangulation_index_.clear();
  for_box<dim>(low, high, [&](const CellIndex<dim>& index) {
    triangulation_index_.push_back(-1);
    if (!is_fluid(shape, index)) return;
    triangulation_index_.back() = static_cast<int>(lattice_index_.size());
    lattice_index_.push_back(index);
    dealii::CellData<dim> cell;
    for (unsigned int corner = 0; corner < cell.vertices.size(); ++corner) {
      CellIndex<dim> point = index;
      for (int axis = 0; axis < dim; ++axis) point[axis] += static_cast<int>(corner >> axis & 1U);
      cell.vertices[corner] = vertex_of(point);
    }
    description.coarse_cells.push_back(cell);
    const auto id = static_cast<dealii::types::coarse_cell_id>(number(index));
    description.coarse_cell_index_to_coarse_cell_id.push_back(id);

    dealii::TriangulationDescription::CellData<dim> info;
    info.id = dealii::CellId(id, std::vector<std::uint8_t>()).template to_binary<dim>();
    const auto owner = std::upper_bound(first_of_rank_.begin(), first_of_rank_.end(), index[0]) - 1;
    info.subdomain_id = static_cast<dealii::types::subdomain_id>(owner - first_of_rank_.begin());
    info.level_subdomain_id = info.subdomain_id;
    info.manifold_id = dealii::numbers::flat_manifold_id;
    info.manifold_line_ids.fill(dealii::numbers::flat_manifold_id);
    info.manifold_quad_ids.fill(dealii::numbers::flat_manifold_id);
    for (int side = 0; side < 2 * dim; ++side) {
      CellIndex<dim> beyond = index;
      beyond[side / 2] += side % 2 == 0 ? -1 : 1;
      const bool outer = beyond[side / 2] < 0 || beyond[side / 2] >= n_cells(side / 2);
      const bool fluid = is_fluid(shape, beyond);
      const bool held = beyond[0] >= held_[0] && beyond[0] < held_[1];
      if (fluid && held) continue;
      const int what = outer ? side : fluid ? elsewhere : inner_side;
      info.boundary_ids.emplace_back(side, static_cast<dealii::types::boundary_id>(what));
    }
    description.cell_infos[0].push_back(info);
  });
  triangulation_.create_triangulation(description);
}

template <int dim>
void LatticeMesh<dim>::check_cells() const {
  const dealii::FE_Nothing<dim> element;
  const dealii::QGaussLobatto<dim> points(3);
  dealii::FEValues<dim> values(mapping_, element, points,
                               dealii::update_jacobians | dealii::update_quadrature_points);
  for (const auto& cell : triangulation_.active_cell_iterators()) {
    if (!cell->is_locally_owned()) continue;
    values.reinit(typename dealii::Triangulation<dim>::cell_iterator(cell));
    for (const unsigned int q : values.quadrature_point_indices()) {
      if (values.jacobian(q).determinant() > 0.0) continue;
      const auto& place = values.quadrature_point(q);
      throw InputError(
          kWhere, fmt::format("the cells fold at x = {:.4g}, y = {:.4g} gaps", place[0], place[1]),
          "The wall turns too sharply for them: take more cells along the channel");
    }
  }
}

template <int dim>
typename LatticeMesh<dim>::Located LatticeMesh<dim>::locate(const Point& chart) const {
  Located located;
  for (int axis = 0; axis < dim; ++axis) {
    const std::vector<double>& e = edges_[axis];
    const auto above = std::upper_bound(e.begin(), e.end(), chart[axis]);
    const int index = std::clamp(static_cast<int>(above - e.begin()) - 1, 0, n_cells(axis) - 1);
    located.index[axis] = index;
    located.unit[axis] = std::clamp((chart[axis] - e[index]) / (e[index + 1] - e[index]), 0.0, 1.0);
  }
  return located;
}

template <int dim>
std::optional<typename LatticeMesh<dim>::Cell> LatticeMesh<dim>::own_cell(
    const dealii::DoFHandler<dim>& dofs, const CellIndex<dim>& index) const {
  if (index[0] < own_[0] || index[0] >= own_[1]) return std::nullopt;
  CellIndex<dim> low{}, high;
  for (int axis = 0; axis < dim; ++axis) high[axis] = n_cells(axis);
  low[0] = held_[0];
  high[0] = held_[1];
  const int found = triangulation_index_[number_in<dim>(low, high, index)];
  if (found < 0) return std::nullopt;
  return Cell(&dofs.get_triangulation(), 0, found, &dofs);
}

template <int dim>
CellIndex<dim> LatticeMesh<dim>::index_of(
    const typename dealii::Triangulation<dim>::cell_iterator& cell) const {
  return lattice_index_[static_cast<std::size_t>(cell->index())];
}

template <int dim>
typename LatticeMesh<dim>::Point LatticeMesh<dim>::chart(
    const typename dealii::Triangulation<dim>::cell_iterator& cell,
    const dealii::Point<dim>& unit) const {
  const CellIndex<dim> index = index_of(cell);
  Point chart;
  for (int axis = 0; axis < dim; ++axis) {
    const double low = edges_[axis][index[axis]], high = edges_[axis][index[axis] + 1];
    chart[axis] = low + unit[axis] * (high - low);
  }
  return chart;
}

template class LatticeMesh<2>;
template class LatticeMesh<3>;

}  // namespace manoscope::navier_stokes
