// Where missing pixels leave gaps in the columns of a channel: the inside of LinearPass.
#pragma once

#include <bit>
#include <cstdint>
#include <vector>

#include "manoscope/maps/column_weights.hpp"
#include "manoscope/maps/linear_geometry.hpp"
#include "manoscope/maps/linear_kernels.hpp"

namespace manoscope::maps::linear {

/// Calls `found(row of the block, column)` for every bit of a word of Block::missing.
template <class Found>
[[gnu::always_inline]] inline void for_each_bit(std::uint64_t word, Index group,
                                                const Found& found) {
  for (; word != 0; word &= word - 1) {
    const auto bit = static_cast<unsigned>(std::countr_zero(word));
    found(static_cast<Index>(bit / kLanes), group * kLanes + static_cast<Index>(bit % kLanes));
  }
}

/// The pixels at hand: of the block at work and of the row before it.
struct Pixels {
  const char *rows, *before;
  Index first, row_bytes;  ///< row of the map that the block begins with

  float height(Index iz, Index ix) const {
    const char* const row = iz < first ? before : rows + (iz - first) * row_bytes;
    float value = 0.0F;
    std::memcpy(&value, row + 4 * ix, sizeof value);
    return value;
  }
};

/// The gaps of a map's columns, and what they change in each column's width average; follows the
/// rows as they come.
class MapGaps {
 public:
  explicit MapGaps(const LinearReducer::Geometry& geometry);
  void reset();

  /// Whether a block without a missing pixel need be followed.
  bool any_open() const { return any_open_; }
  void follow(const Block& block, const Pixels& pixels);
  /// Closes what is open, after the last row.
  void close_all();

  Index missing() const { return n_missing_; }
  bool in_column(Index ix) const { return of(ix).singles > 0 || of(ix).several; }

  /// What gaps change in one column.
  struct Change {
    ColumnGaps weights;
    Index n_inside = 0;    ///< missing pixels inside the channel
    double height = 0.0;   ///< added to the weighted sum of heights
    bool dropped = false;  ///< too wide a gap to be bridged
  };
  Change in(Index ix) const {
    const Column& column = of(ix);
    Change change;
    if (column.several) change = several_[static_cast<std::size_t>(ix)];
    const double n = column.singles;
    change.n_inside += column.singles;
    change.height += single_by_ * column.heights;
    change.weights.squares += n * single_squares_ + column.shared * (2.0 * single_by_ * single_by_);
    change.weights.sixth += n * single_sixth_;
    return change;
  }

 private:
  struct Rows;

  /// Most gaps are one pixel between inner rows. They have the same effect on the weights, and are
  /// counted; what others change is in `several_`.
  struct Column {
    float before = 0.0F;     ///< height before the open gap
    std::int32_t first = 0;  ///< its first row
    double heights = 0.0;    ///< sum of the heights on either side of single gaps
    std::int32_t singles = 0;
    std::int32_t shared = 0;  ///< pairs of single gaps with one pixel between
    std::int32_t upper = -1;  ///< row after the last gap
    bool last_single = false, several = false;

    void add_single(Index at, double beside) {
      heights += beside;
      ++singles;
      shared += static_cast<std::int32_t>(upper == at - 2);
      upper = static_cast<std::int32_t>(at);
      last_single = true;
    }
  };

  const Column& of(Index ix) const { return columns_[static_cast<std::size_t>(ix)]; }
  void open(Index ix, Index iz, const Pixels& pixels);
  void close(Index ix, Index upper, const Pixels& pixels);
  void close_at_edge(Index ix, Index lower, Index upper, bool next_to_single, const Pixels& pixels);

  const LinearReducer::Geometry& geometry_;
  double single_by_, single_squares_, single_sixth_;
  Index n_missing_ = 0;
  bool any_open_ = false;
  std::vector<std::uint8_t> open_;  ///< a bit a column, set where the last row lies in a gap
  std::vector<Column> columns_;
  std::vector<Change> several_;
  std::vector<Index> with_several_;
};

}  // namespace manoscope::maps::linear
