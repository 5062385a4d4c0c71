#include "manoscope/wall/hermite_grid.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "manoscope/core/error.hpp"

namespace manoscope::wall {

HermiteValues hermite(double s, double h, int derivative) {
  MANO_ASSERT(derivative >= 0 && derivative <= 2);
  switch (derivative) {
    case 0:
      return {1.0 + s * s * (2.0 * s - 3.0), h * s * (1.0 + s * (s - 2.0)), s * s * (3.0 - 2.0 * s),
              h * s * s * (s - 1.0)};
    case 1:
      return {6.0 * s * (s - 1.0) / h, 1.0 + s * (3.0 * s - 4.0), 6.0 * s * (1.0 - s) / h,
              s * (3.0 * s - 2.0)};
    default:
      return {(12.0 * s - 6.0) / (h * h), (6.0 * s - 4.0) / h, (6.0 - 12.0 * s) / (h * h),
              (6.0 * s - 2.0) / h};
  }
}

HermiteValues hermite_integral(double h) { return {h / 2.0, h * h / 12.0, h / 2.0, -h * h / 12.0}; }

HermiteAxis::HermiteAxis(Array1 nodes) : nodes_(std::move(nodes)) {
  MANO_ASSERT(nodes_.size() >= 2);
  for (Index i = 0; i + 1 < nodes_.size(); ++i) MANO_ASSERT(nodes_(i) < nodes_(i + 1));
}

Index HermiteAxis::cell_of(double position) const {
  const double* begin = nodes_.data();
  const double* end = begin + nodes_.size();
  const Index above = std::upper_bound(begin, end, position) - begin;
  return std::clamp<Index>(above - 1, 0, n_cells() - 1);
}

namespace {

/// Nodes of [0, span] refined at 0: equal shares of the integral of the density.
Array1 graded_from_zero(double span, double layer, double evenness, Index n_cells) {
  const auto share = [&](double s) { return std::log1p(s / layer) + evenness * s; };
  Array1 nodes(n_cells + 1);
  nodes(0) = 0.0;
  for (Index k = 1; k < n_cells; ++k) {
    const double wanted = share(span) * double(k) / double(n_cells);
    double low = nodes(k - 1), high = span;
    while (true) {
      const double middle = 0.5 * (low + high);
      if (!(middle > low && middle < high)) break;
      (share(middle) < wanted ? low : high) = middle;
    }
    nodes(k) = high;
  }
  nodes(n_cells) = span;
  return nodes;
}

}  // namespace

Array1 graded_nodes(double first, double last, RefinedEnds ends, double layer, double evenness,
                    Index n_cells) {
  MANO_ASSERT(last > first && layer > 0.0 && evenness >= 0.0 && n_cells >= 1);
  if (ends == RefinedEnds::last) {
    const Array1 from_end = graded_from_zero(last - first, layer, evenness, n_cells);
    Array1 nodes = last - from_end.reverse();
    nodes(0) = first;
    return nodes;
  }
  MANO_ASSERT(n_cells % 2 == 0);
  const Index half = n_cells / 2;
  const Array1 from_end = graded_from_zero(0.5 * (last - first), layer, evenness, half);
  Array1 nodes(n_cells + 1);
  for (Index k = 0; k <= half; ++k) {
    nodes(n_cells - k) = last - from_end(k);
    nodes(k) = first + from_end(k);
  }
  return nodes;
}

}  // namespace manoscope::wall
