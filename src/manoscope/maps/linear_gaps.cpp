#include "manoscope/maps/linear_gaps.hpp"

#include <algorithm>
#include <cmath>

namespace manoscope::maps::linear {
namespace {

/// Bits of the first n rows of a word of Block::missing.
std::uint64_t rows_up_to(Index n) {
  if (n <= 0) return 0;
  return ~std::uint64_t{0} >> (64 - kLanes * std::min(n, kRows));
}

/// What happens to gaps in a block, a word to kLanes columns.
struct FindEvents {
  /// Reads the missing pixels, of which only those `inside` the channel count.
  /// @param last_rows     as MapGaps; brought up to date.
  /// @param all           rows of the block
  /// @param single_rows   rows after a single gap that has a good pixel and two inner rows about it
  /// @param singles       set at the good pixel that ends such a gap
  /// @param others        set where any other gap ends, and at the second pixel of a gap
  /// @param n_rows        of the block
  template <class Lanes>
  [[gnu::always_inline]] static void run(const std::uint64_t* missing, const std::uint64_t* inside,
                                         std::uint64_t* last_rows, std::uint64_t all,
                                         std::uint64_t single_rows, std::uint64_t* singles,
                                         std::uint64_t* others, Index n_rows, Index n_words) {
    const auto shift = static_cast<unsigned>(8 * (n_rows - 1));
    for (Index k = 0; k < n_words; ++k) {
      const std::uint64_t here = missing[k] & inside[k], before = last_rows[k];
      const std::uint64_t above = here << 8 | (before & 0xff);
      const std::uint64_t two_above = above << 8 | before >> 8;
      const std::uint64_t ends = ~here & above & all;
      const std::uint64_t ends_single = ends & ~two_above & single_rows;
      const std::uint64_t other = (ends & ~ends_single) | (here & above & ~two_above);
      // In a column with others all take the careful way, one after the other.
      std::uint64_t columns = other | other >> 32;
      columns |= columns >> 16;
      columns |= columns >> 8;
      columns &= 0xff;
      columns |= columns << 8;
      columns |= columns << 16;
      columns |= columns << 32;
      singles[k] = ends_single & ~columns;
      others[k] = other | (ends_single & columns);
      last_rows[k] = (here >> shift & 0xff) | (above >> shift & 0xff) << 8;
    }
  }
};

}  // namespace

MapGaps::MapGaps(const LinearReducer::Geometry& geometry, numerics::Instructions instructions)
    : geometry_(geometry),
      instructions_(instructions),
      last_rows_(geometry.inside.size()),
      singles_(geometry.inside.size()),
      others_(geometry.inside.size()),
      list_(geometry.inside.size()),
      columns_(geometry.inside.size() * kLanes),
      open_(columns_.size(), Open{kNone, 0.0F}),
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
  std::fill(last_rows_.begin(), last_rows_.end(), std::uint64_t{0});
  std::fill(columns_.begin(), columns_.end(), Column{});
  for (const Index ix : with_several_) several_[static_cast<std::size_t>(ix)] = {};
  with_several_.clear();
}

/// Opens and closes gaps where the pixels of a column change from good to missing and back.
void MapGaps::follow(const Block& block, Index first, const Pixels& pixels) {
  const LinearReducer::Geometry& g = geometry_;
  const Index begin = block.first / kLanes, end = block.end / kLanes;
  // A gap of one pixel is a single one if it and the pixels about it lie in inner rows.
  const std::uint64_t single_rows =
      rows_up_to(g.inner_end - first) & ~rows_up_to(g.inner_begin + 2 - first);
  numerics::run_in_lanes<FindEvents>(instructions_, block.missing + begin, g.inside.data() + begin,
                                     last_rows_.data() + begin, rows_up_to(block.n_rows),
                                     single_rows, singles_.data() + begin, others_.data() + begin,
                                     block.n_rows, end - begin);
  list_.clear();
  std::uint64_t open = 0;
  for (Index group = begin; group < end; ++group) {
    const auto at = static_cast<std::size_t>(group);
    list_.add(singles_[at], group);
    open |= last_rows_[at] & 0xff;
    for_each_bit(others_[at], group, [&](BlockPixel pixel) {
      const Index ix = pixel.column, iz = first + pixel.row;
      if ((block.missing[at] >> (kLanes * pixel.row + ix % kLanes) & 1) != 0) {
        open_[static_cast<std::size_t>(ix)] = opened(ix, iz - 1, pixels);
      } else {
        close(ix, iz, pixels);
      }
    });
  }
  any_open_ = open != 0;
  for (const std::uint32_t at : list_) {
    const BlockPixel pixel(at);
    const Index upper = first + pixel.row;
    Column& column = columns_[static_cast<std::size_t>(pixel.column)];
    if (column.follows_other(upper)) {
      close(pixel.column, upper, pixels);
      continue;
    }
    column.add_single(upper, double{pixels.height(upper - 2, pixel.column)} +
                                 double{pixels.height(upper, pixel.column)});
    ++n_missing_;
  }
  if (any_open_ && first + block.n_rows == g.weights.last + 1) close_all(begin, end, pixels);
}

/// Closes what is open after the last row.
void MapGaps::close_all(Index begin, Index end, const Pixels& pixels) {
  for (Index group = begin; group < end; ++group) {
    for_each_bit(last_rows_[static_cast<std::size_t>(group)] & 0xff, group, [&](BlockPixel pixel) {
      close(pixel.column, geometry_.weights.last + 1, pixels);
    });
  }
  any_open_ = false;
}

MapGaps::Open MapGaps::opened(Index ix, Index iz, const Pixels& pixels) const {
  return {iz, iz > geometry_.weights.first ? pixels.height(iz - 1, ix) : 0.0F};
}

/// Closes the open gap of a column at the good pixel of row `upper`, or beyond the last row.
void MapGaps::close(Index ix, Index upper, const Pixels& pixels) {
  const LinearReducer::Geometry& g = geometry_;
  Column& column = columns_[static_cast<std::size_t>(ix)];
  Open& open = open_[static_cast<std::size_t>(ix)];
  const Open gap = open.first == kNone ? opened(ix, upper - 1, pixels) : open;
  open.first = kNone;
  const Index lower = gap.first - 1;
  n_missing_ += upper - lower - 1;
  if (upper == lower + 2 && lower >= g.inner_begin && upper < g.inner_end &&
      !column.follows_other(upper)) {
    return column.add_single(upper, double{gap.before} + double{pixels.height(upper, ix)});
  }
  if (!column.several) with_several_.push_back(ix);
  column.several = true;
  const bool next_to_single = column.upper == lower && column.last_single;
  column.upper = static_cast<std::int32_t>(upper);
  column.last_single = false;
  Change& change = several_[static_cast<std::size_t>(ix)];
  change.n_inside += std::min(upper, g.weights.last) - std::max(lower + 1, g.weights.first + 1);
  if (lower <= g.weights.first || upper >= g.weights.last) {
    return close_at_edge(ix, upper, gap, next_to_single, pixels);
  }
  const double largest = std::max(g.options.largest_gap * g.width, 2.5 * g.grid.pitch_z.si());
  if (g.grid.z(upper) - g.grid.z(lower) > largest) {
    change.dropped = true;
    return;
  }
  const double by = change.weights.close(g.weights, g.grid, lower, upper, g.width);
  if (next_to_single) change.weights.squares += 2.0 * by * single_by_;
  change.height += by * (double{gap.before} + double{pixels.height(upper, ix)});
}

/// The same where the gap reaches an edge: the clamped edge itself, zeta = 0, takes the place of
/// the pixel beyond it.
void MapGaps::close_at_edge(Index ix, Index upper, const Open& gap, bool next_to_single,
                            const Pixels& pixels) {
  const LinearReducer::Geometry& g = geometry_;
  const ColumnWeights& weights = g.weights;
  const Index lower = gap.first - 1;
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
  const double before = gap.before;
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

}  // namespace manoscope::maps::linear
