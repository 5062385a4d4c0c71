#pragma once

#include <array>

#include "manoscope/core/arrays.hpp"

namespace manoscope::wall {

/// Cubic Hermite functions of one cell: value and slope at its first node, then at its last.
using HermiteValues = std::array<double, 4>;

/// The four cubic Hermite functions of a cell, or a derivative of them with respect to length.
///
/// @param s  Position in the cell, 0 at its first node, 1 at its last.
/// @param h  Cell length, h > 0.
/// @param derivative  0, 1 or 2.
HermiteValues hermite(double s, double h, int derivative);

/// Integrals of the four Hermite functions over a whole cell of length h.
HermiteValues hermite_integral(double h);

/// Nodes of one direction of a grid of cubic Hermite cells.
class HermiteAxis {
 public:
  /// @param nodes  (n), n >= 2, strictly ascending.
  explicit HermiteAxis(Array1 nodes);

  Index n_nodes() const { return nodes_.size(); }
  Index n_cells() const { return nodes_.size() - 1; }
  double node(Index i) const { return nodes_(i); }
  double size(Index cell) const { return nodes_(cell + 1) - nodes_(cell); }
  double first() const { return nodes_(0); }
  double last() const { return nodes_(nodes_.size() - 1); }
  const Array1& nodes() const { return nodes_; }

  /// Cell that holds a position; positions outside belong to the nearest cell.
  Index cell_of(double position) const;
  /// Position within a cell, 0 at its first node, 1 at its last.
  double local(Index cell, double position) const { return (position - nodes_(cell)) / size(cell); }

 private:
  Array1 nodes_;
};

/// Where a graded axis is refined.
enum class RefinedEnds { both, last };

/// Nodes dense within a layer at the ends of [first, last] and evenly spaced far from them.
///
/// The number of cells per length is proportional to 1/(layer + s) + evenness, s the distance from
/// the nearest refined end. More cells refine the same grading, so that convergence orders show.
///
/// @param layer     Thickness of the layer, > 0.
/// @param evenness  Weight of the even spacing, 1 per length, >= 0.
/// @param n_cells   Number of cells, >= 1 (>= 2 and even if both ends are refined).
Array1 graded_nodes(double first, double last, RefinedEnds ends, double layer, double evenness,
                    Index n_cells);

}  // namespace manoscope::wall
