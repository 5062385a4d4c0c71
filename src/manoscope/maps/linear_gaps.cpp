#include "manoscope/maps/linear_gaps.hpp"

#include <algorithm>
#include <cmath>

namespace manoscope::maps::linear {

MapGaps::MapGaps(const LinearReducer::Geometry& geometry)
    : geometry_(geometry),
      open_(geometry.inside.size()),
      columns_(geometry.inside.size() * kLanes),
      several_(columns_.size()) {
  // By ColumnGaps::close() where all weights are alike: what the pixel gives goes to the two beside
  // it in halves, and sum and balance of the weights stay.
  const double weight = geometry.inner_weight, gap = 2.0 * geometry.grid.pitch_z.si();
  single_by_ = 0.5 * weight;
  single_squares_ = 2.0 * single_by_ * (2.0 * weight + single_by_) - weight * weight;
  single_sixth_ = std::pow(gap * gap * gap, 2);
}

void MapGaps::reset() {
  if (n_missing_ == 0) return;
  n_missing_ = 0;
  any_open_ = false;
  std::fill(open_.begin(), open_.end(), std::uint8_t{0});
  std::fill(columns_.begin(), columns_.end(), Column{});
  for (const Index ix : with_several_) several_[static_cast<std::size_t>(ix)] = {};
  with_several_.clear();
}

/// Single gaps that a block shows with two good pixels on either side, in columns that show no
/// other gap: which of them is taken first makes no difference.
struct MapGaps::Rows {
  std::uint64_t all,
      singles;  ///< rows of the block; those where a gap of one pixel is taken at once

  Rows(const LinearReducer::Geometry& g, const Block& block, Index first)
      : all(up_to(block.n_rows)), singles(0) {
    // Two rows before must be known, and the row after must be in the block.
    const Index begin = std::max<Index>(1, g.inner_begin + 1 - first);
    const Index end = std::min(block.n_rows, g.inner_end - first) - 1;
    if (end > begin) singles = up_to(end) & ~up_to(begin);
  }
  static std::uint64_t up_to(Index n) { return n == 0 ? 0 : ~std::uint64_t{0} >> (64 - 8 * n); }

  std::uint64_t alone(std::uint64_t missing, std::uint8_t open) const {
    const std::uint64_t above = missing << 8 | open, two_above = above << 8;
    const std::uint64_t near = above | two_above | missing >> 8 | missing >> 16;
    const std::uint64_t found = missing & ~near & singles;
    const std::uint64_t rest = missing & ~found;
    std::uint64_t columns = (rest ^ (rest << 8 | open)) & all;
    columns |= columns >> 32;
    columns |= columns >> 16;
    columns |= columns >> 8;
    return found & ~((columns & 0xff) * 0x0101010101010101);
  }
};

/// Opens and closes gaps where the pixels of a column change from good to missing and back.
void MapGaps::follow(const Block& block, const Pixels& pixels) {
  const LinearReducer::Geometry& g = geometry_;
  const Rows rows(g, block, pixels.first);
  const Index last_row = kLanes * (block.n_rows - 1), row_bytes = pixels.row_bytes;
  const std::uint64_t *const words = block.missing, *const inside = g.inside.data();
  Column* const columns = columns_.data();
  std::uint8_t* const open = open_.data();
  unsigned any_open = 0;
  Index n_singles = 0;
  for (Index group = block.first / kLanes; group < block.end / kLanes; ++group) {
    const std::uint64_t missing = words[group] & inside[group];
    const std::uint8_t open_before = open[group];
    const std::uint64_t alone = rows.alone(missing, open_before);
    for_each_bit(alone, group, [&](Index r, Index ix) {
      const char* const at = pixels.rows + (r - 1) * row_bytes + 4 * ix;
      float before = 0.0F, after = 0.0F;
      std::memcpy(&before, at, sizeof before);
      std::memcpy(&after, at + 2 * row_bytes, sizeof after);
      columns[ix].add_single(pixels.first + r + 1, double{before} + double{after});
      ++n_singles;
    });
    const std::uint64_t others = missing & ~alone, above = others << kLanes | open_before;
    for_each_bit((others ^ above) & rows.all, group, [&](Index r, Index ix) {
      if ((above >> (kLanes * r + ix % kLanes) & 1) != 0) {
        close(ix, pixels.first + r, pixels);
      } else {
        this->open(ix, pixels.first + r, pixels);
      }
    });
    open[group] = static_cast<std::uint8_t>(missing >> last_row);
    any_open |= open[group];
  }
  any_open_ = any_open != 0;
  n_missing_ += n_singles;
}

void MapGaps::open(Index ix, Index iz, const Pixels& pixels) {
  Column& column = columns_[static_cast<std::size_t>(ix)];
  column.first = static_cast<std::int32_t>(iz);
  column.before = iz > geometry_.weights.first ? pixels.height(iz - 1, ix) : 0.0F;
}

/// Closes the open gap of a column at the good pixel of row `upper`, or beyond the last row.
void MapGaps::close(Index ix, Index upper, const Pixels& pixels) {
  const LinearReducer::Geometry& g = geometry_;
  Column& column = columns_[static_cast<std::size_t>(ix)];
  const Index lower = column.first - 1;
  n_missing_ += upper - lower - 1;
  if (upper == lower + 2 && lower >= g.inner_begin && upper < g.inner_end &&
      (column.upper != lower || column.last_single)) {
    return column.add_single(upper, double{column.before} + double{pixels.height(upper, ix)});
  }
  if (!column.several) with_several_.push_back(ix);
  column.several = true;
  const bool next_to_single = column.upper == lower && column.last_single;
  column.upper = static_cast<std::int32_t>(upper);
  column.last_single = false;
  Change& change = several_[static_cast<std::size_t>(ix)];
  change.n_inside += std::min(upper, g.weights.last) - std::max(lower + 1, g.weights.first + 1);
  if (lower <= g.weights.first || upper >= g.weights.last) {
    return close_at_edge(ix, lower, upper, next_to_single, pixels);
  }
  const double largest = std::max(g.options.largest_gap * g.width, 2.5 * g.grid.pitch_z.si());
  if (g.grid.z(upper) - g.grid.z(lower) > largest) {
    change.dropped = true;
    return;
  }
  const double by = change.weights.close(g.weights, g.grid, lower, upper, g.width);
  if (next_to_single) change.weights.squares += 2.0 * by * single_by_;
  change.height += by * (double{column.before} + double{pixels.height(upper, ix)});
}

/// The same where the gap reaches an edge: the clamped edge itself, zeta = 0, takes the place of
/// the pixel beyond it.
void MapGaps::close_at_edge(Index ix, Index lower, Index upper, bool next_to_single,
                            const Pixels& pixels) {
  const LinearReducer::Geometry& g = geometry_;
  const ColumnWeights& weights = g.weights;
  const Column& column = of(ix);
  Change& change = several_[static_cast<std::size_t>(ix)];
  const bool below = lower <= weights.first;
  if (below && upper >= weights.last) {
    change.dropped = true;
    return;
  }
  // The good pixel that is left, the rows that lose their weight, and what the one beyond the edge
  // had given if it is good.
  const Index node = below ? upper : lower;
  const Index from = below ? weights.first : lower + 1, to = below ? upper - 1 : weights.last;
  const double before = column.before;
  if (below && lower == weights.first) change.height -= weights.of(lower) * before;
  if (!below && upper == weights.last) {
    change.height -= weights.of(upper) * double{pixels.height(upper, ix)};
  }
  for (Index iz = from; iz <= to; ++iz) change.weights.remove(weights, g.grid, iz);
  const double pitch = g.grid.pitch_z.si();
  const double to_edge = 0.5 * g.width - (below ? -1.0 : 1.0) * g.grid.z(node);
  if (to_edge > std::max(g.options.largest_gap * g.width, 2.5 * pitch)) change.dropped = true;
  const double by = 0.5 * (to_edge + pitch) / g.width - weights.of(node);
  change.weights.grow(weights, g.grid, node, by);
  if (!below && next_to_single) change.weights.squares += 2.0 * by * single_by_;
  change.height += by * (below ? double{pixels.height(node, ix)} : before);
  if (to_edge >= 1.5 * pitch) change.weights.sixth += std::pow(to_edge, 6);
}

void MapGaps::close_all() {
  if (!any_open_) return;
  const Pixels none{nullptr, nullptr, 0, 0};  // no row lies beyond the last
  for (std::size_t group = 0; group < open_.size(); ++group) {
    for_each_bit(open_[group], static_cast<Index>(group),
                 [&](Index, Index ix) { close(ix, geometry_.weights.last + 1, none); });
  }
  any_open_ = false;
}

}  // namespace manoscope::maps::linear
