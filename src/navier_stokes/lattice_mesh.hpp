#pragma once

#include <deal.II/distributed/fully_distributed_tria.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/mapping_q_cache.h>

#include <array>
#include <functional>
#include <optional>
#include <vector>

namespace manoscope::navier_stokes {

template <int dim>
using Edges = std::array<std::vector<double>, dim>;

/// Place of a cell in the lattice: its number along each axis.
template <int dim>
using CellIndex = std::array<int, dim>;

/// Cells of a lattice of edges, some of them taken out, mapped to where they stand in space.
///
/// The triangulation is that of the lattice; the mapping, of the given polynomial degree, holds the
/// shape. Columns of cells along the first axis are dealt out evenly: a process holds its own, one
/// more on either side, and nothing of the rest. Outer sides carry the boundary ids 2 a (low end of
/// axis a) and 2 a + 1 (high end), faces to cells that are taken out inner_side.
template <int dim>
class LatticeMesh {
 public:
  using Point = std::array<double, dim>;
  using Triangulation = dealii::parallel::fullydistributed::Triangulation<dim>;
  using Cell = typename dealii::DoFHandler<dim>::active_cell_iterator;

  static constexpr int inner_side = 2 * dim;
  static constexpr int elsewhere = 2 * dim + 1;  ///< faces to cells that no process nearby holds

  struct Shape {
    Edges<dim> edges;                                ///< ascending, at least two each
    std::function<bool(const Point& centre)> solid;  ///< cells without fluid; empty: none
    std::function<Point(const Point& chart)> place;  ///< asked from several threads at once
  };

  /// @throws what `place` throws at the lowest point; InputError if there are fewer columns than
  ///         processes, no cell at all, or a cell is turned inside out.
  LatticeMesh(MPI_Comm comm, const Shape& shape, int degree);

  const Triangulation& triangulation() const { return triangulation_; }
  const dealii::Mapping<dim>& mapping() const { return mapping_; }
  const Edges<dim>& edges() const { return edges_; }
  int n_cells(int axis) const { return static_cast<int>(edges_[axis].size()) - 1; }
  /// Columns of this process, from first to before last.
  std::array<int, 2> own_columns() const { return own_; }

  /// A point of the lattice: its cell, the one above where it is an edge but for the last, and the
  /// place in it from 0 to 1.
  struct Located {
    CellIndex<dim> index{};
    dealii::Point<dim> unit;
  };
  Located locate(const Point& chart) const;
  /// The cell of a lattice index; none where it is solid or belongs to another process.
  std::optional<Cell> own_cell(const dealii::DoFHandler<dim>& dofs,
                               const CellIndex<dim>& index) const;
  Point chart(const typename dealii::Triangulation<dim>::cell_iterator& cell,
              const dealii::Point<dim>& unit) const;
  CellIndex<dim> index_of(const typename dealii::Triangulation<dim>::cell_iterator& cell) const;

 private:
  std::int64_t number(const CellIndex<dim>& index) const;
  bool is_fluid(const Shape& shape, const CellIndex<dim>& index) const;
  void deal_out(MPI_Comm comm, const Shape& shape);
  void build(MPI_Comm comm, const Shape& shape);
  void map(const Shape& shape);
  void check_cells() const;

  Edges<dim> edges_;
  std::vector<int> first_of_rank_;  ///< (processes + 1) columns
  std::array<int, 2> own_{}, held_{};
  Triangulation triangulation_;
  dealii::MappingQCache<dim> mapping_;
  std::vector<int> triangulation_index_;       ///< (held lattice cells), -1: solid
  std::vector<CellIndex<dim>> lattice_index_;  ///< (cells of the triangulation)
};

}  // namespace manoscope::navier_stokes
