// Where missing pixels leave gaps in the columns of a channel: the inside of LinearPass.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <vector>

#include "manoscope/maps/column_weights.hpp"
#include "manoscope/maps/linear_geometry.hpp"
#include "manoscope/maps/linear_kernels.hpp"

namespace manoscope::maps::linear {

/// A bit set in the words of a block: a row of it and a column.
struct BlockPixel {
  Index row, column;
  /// @param at  64 times the word's place among the block's, and the bit's place in it.
  explicit BlockPixel(std::uint32_t at)
      : row(at / kLanes % kRows), column(at / 64 * kLanes + at % kLanes) {}
};

/// Calls `found(BlockPixel)` for every bit of a word, the lowest first.
template <class Found>
[[gnu::always_inline]] inline void for_each_bit(std::uint64_t word, Index group,
                                                const Found& found) {
  for (; word != 0; word &= word - 1) {
    found(BlockPixel(static_cast<std::uint32_t>(64 * group + std::countr_zero(word))));
  }
}

/// The bits of words of which most have few: a list, made without a branch on what they are.
class BitList {
 public:
  explicit BitList(std::size_t n_words) : at_(64 * n_words + 2) {}
  void clear() { n_ = 0; }
  void add(std::uint64_t word, Index group) {
    const auto base = static_cast<std::uint32_t>(64 * group);
    word = add_lowest(add_lowest(word, base), base);
    while (word != 0) [[unlikely]] word = add_lowest(word, base);
  }
  const std::uint32_t* begin() const { return at_.data(); }
  const std::uint32_t* end() const { return at_.data() + n_; }

 private:
  std::uint64_t add_lowest(std::uint64_t word, std::uint32_t base) {
    constexpr std::uint64_t kLast = std::uint64_t{1} << 63;  // no word is empty then
    at_[n_] = base + static_cast<std::uint32_t>(std::countr_zero(word | kLast));
    n_ += static_cast<std::size_t>(word != 0);
    return word & (word - 1);
  }
  std::vector<std::uint32_t> at_;
  std::size_t n_ = 0;
};

/// The pixels at hand: some rows, and copies of the two before them.
struct Pixels {
  const char *rows, *before;
  Index first, row_bytes;  ///< row of the map that `rows` begin with

  float height(Index iz, Index ix) const {
    const char* const row =
        iz >= first ? rows + (iz - first) * row_bytes : before + (iz - first + 2) * row_bytes;
    float value = 0.0F;
    std::memcpy(&value, row + 4 * ix, sizeof value);
    return value;
  }
};

/// The gaps of a map's columns, and what they change in each column's width average; follows the
/// rows as they come.
class MapGaps {
 public:
  MapGaps(const LinearReducer::Geometry& geometry, numerics::Instructions instructions);
  void reset();

  /// Whether a block without a missing pixel need be followed.
  bool any_open() const { return any_open_; }
  /// @param first  row of the map that the block begins with.
  void follow(const Block& block, Index first, const Pixels& pixels);

  Index missing() const { return n_missing_; }

  /// What gaps of one pixel between inner rows change in a column. They leave the sum of the
  /// weights and their balance as they are.
  struct Singles {
    double count;                   ///< each one missing pixel inside the channel
    double height, squares, sixth;  ///< as in Change
  };
  Singles singles_in(Index ix) const {
    const Column& column = of(ix);
    const double n = column.singles;
    return {n, single_by_ * column.heights,
            n * single_squares_ + column.shared * (2.0 * single_by_ * single_by_),
            n * single_sixth_};
  }

  /// What the other gaps of a column change.
  struct Change {
    ColumnGaps weights;
    Index n_inside = 0;    ///< missing pixels inside the channel
    double height = 0.0;   ///< added to the weighted sum of heights
    bool dropped = false;  ///< too wide a gap to be bridged
  };
  const std::vector<Index>& with_several() const { return with_several_; }  ///< columns
  const Change& several_in(Index ix) const { return several_[static_cast<std::size_t>(ix)]; }

 private:
  /// Most gaps are one pixel between inner rows. They have the same effect on the weights, and are
  /// counted; what others change is in `several_`.
  struct Column {
    double heights;  ///< sum of the heights on either side of single gaps
    std::int32_t singles;
    std::int32_t shared;  ///< pairs of single gaps with one pixel between
    std::int32_t upper;   ///< row after the last gap
    bool last_single, several;

    /// Whether the gap before shares the pixel between with a single gap that ends at `at`, and is
    /// no single one itself.
    bool follows_other(Index at) const { return upper == at - 2 && !last_single; }
    void add_single(Index at, double beside) {
      heights += beside;
      ++singles;
      shared += static_cast<std::int32_t>(upper == at - 2);
      upper = static_cast<std::int32_t>(at);
      last_single = true;
    }
  };
  /// Where a gap began.
  struct Open {
    Index first;   ///< its first row
    float before;  ///< height before that, 0 if it is the channel's first
  };
  static constexpr Index kNone = -1;

  const Column& of(Index ix) const { return columns_[static_cast<std::size_t>(ix)]; }
  Open opened(Index ix, Index iz, const Pixels& pixels) const;
  void close(Index ix, Index upper, const Pixels& pixels);
  void close_at_edge(Index ix, Index upper, const Open& gap, bool next_to_single,
                     const Pixels& pixels);
  void close_all(Index begin, Index end, const Pixels& pixels);

  const LinearReducer::Geometry& geometry_;
  numerics::Instructions instructions_;
  double single_by_, single_squares_, single_sixth_;
  Index n_missing_ = 0;
  bool any_open_ = false;
  /// A word to kLanes columns: missing pixels of the last row in its low byte, of the one before in
  /// the next.
  std::vector<std::uint64_t> last_rows_;
  std::vector<std::uint64_t> singles_, others_;  ///< of a block, see follow()
  BitList list_;
  std::vector<Column> columns_;
  std::vector<Open> open_;  ///< of gaps of which two pixels were seen; else `first` is kNone
  std::vector<Change> several_;
  std::vector<Index> with_several_;
};

}  // namespace manoscope::maps::linear
