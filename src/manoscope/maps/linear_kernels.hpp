// Sums over the rows of a map, some rows and eight columns at a time: the inside of LinearPass.
#pragma once

#include <cstdint>

#include "manoscope/core/error.hpp"
#include "manoscope/core/index.hpp"
#include "manoscope/numerics/lanes.hpp"

namespace manoscope::maps::linear {

using numerics::kLanes;

/// Rows taken in at a time: sums are fetched and put back once for all of them.
inline constexpr Index kRows = 8;

inline Index whole_lanes(Index n) { return (n + kLanes - 1) / kLanes * kLanes; }

/// A few rows, and the columns to look at, in whole lanes. A missing pixel counts 0 and has its bit
/// set in `missing`: a word to kLanes columns, its lowest byte the first row.
struct Block {
  const char* rows;
  Index n_rows, row_bytes, first, end;
  std::uint64_t* missing;
  bool expects_missing;  ///< a guess, for speed alone
};

/// Adds the rows of a block, kRows of them or fewer, to what `Columns` sums up of kLanes columns at
/// a time.
///
/// Where no pixel is expected to be missing none is looked for: a sum that has come out infinite or
/// NaN tells, and is done again with care. The result is the same.
/// @return how many times kLanes columns hold a missing pixel.
template <class Lanes, bool all_rows, bool expects_missing, class Columns>
[[gnu::always_inline]] inline Index add_columns(const Block& block, const Columns& columns) {
  const char* const rows = block.rows;
  const Index row_bytes = block.row_bytes, end = block.end;
  std::uint64_t* const missing = block.missing;
  const Index n_rows = all_rows ? kRows : block.n_rows;
  Index n_found = 0;
  for (Index ix = block.first; ix < end; ix += kLanes) {
    const char* const at = rows + 4 * ix;
    if constexpr (!expects_missing) {
      auto sums = columns.template load<Lanes>(ix);
      for (Index r = 0; r < n_rows; ++r) sums.add(r, Lanes::floats(at + r * row_bytes));
      if (sums.all_finite()) [[likely]] {
        sums.store(columns, ix);
        missing[ix / kLanes] = 0;
        continue;
      }
    }
    auto sums = columns.template load<Lanes>(ix);
    std::uint64_t all = 0;
    for (Index r = 0; r < n_rows; ++r) {
      unsigned here = 0;
      sums.add(r, Lanes::finite_floats(at + r * row_bytes, here));
      all |= std::uint64_t{here} << (kLanes * r);
    }
    sums.store(columns, ix);
    missing[ix / kLanes] = all;
    n_found += static_cast<Index>(all != 0);
  }
  return n_found;
}

/// Heights of every column.
struct Heights {
  double* sum;

  template <class Lanes>
  struct At {
    Lanes sum;
    [[gnu::always_inline]] void add(Index, Lanes h) { sum = sum + h; }
    [[gnu::always_inline]] bool all_finite() const { return sum.all_finite(); }
    [[gnu::always_inline]] void store(const Heights& to, Index ix) const { sum.store(to.sum + ix); }
  };
  template <class Lanes>
  [[gnu::always_inline]] At<Lanes> load(Index ix) const {
    return {Lanes::load(sum + ix)};
  }
};

/// Weight times height of every column.
struct WeightedHeights {
  double* sum;
  const double* weight;  ///< of the block's rows

  template <class Lanes>
  struct At {
    Lanes sum;
    const double* weight;
    [[gnu::always_inline]] void add(Index r, Lanes h) { sum = sum + Lanes::all(weight[r]) * h; }
    [[gnu::always_inline]] bool all_finite() const { return sum.all_finite(); }
    [[gnu::always_inline]] void store(const WeightedHeights& to, Index ix) const {
      sum.store(to.sum + ix);
    }
  };
  template <class Lanes>
  [[gnu::always_inline]] At<Lanes> load(Index ix) const {
    return {Lanes::load(sum + ix), weight};
  }
};

/// Of every column the heights; the sums of heights that there were after each row, added up: of n
/// rows r = 0 ... n - 1 it holds sum (n - r) h; and the squares.
struct Moments {
  double *height, *stacked, *square;

  template <class Lanes>
  struct At {
    Lanes height, stacked, square;
    [[gnu::always_inline]] void add(Index, Lanes h) {
      height = height + h;
      stacked = stacked + height;
      square = Lanes::plus_square(square, h);
    }
    [[gnu::always_inline]] bool all_finite() const { return height.all_finite(); }
    [[gnu::always_inline]] void store(const Moments& to, Index ix) const {
      height.store(to.height + ix);
      stacked.store(to.stacked + ix);
      square.store(to.square + ix);
    }
  };
  template <class Lanes>
  [[gnu::always_inline]] At<Lanes> load(Index ix) const {
    return {Lanes::load(height + ix), Lanes::load(stacked + ix), Lanes::load(square + ix)};
  }
};

template <bool all_rows>
struct AddColumns {
  template <class Lanes, class Columns>
  [[gnu::always_inline]] static void run(const Block* block, Columns columns, Index* n_found) {
    *n_found = block->expects_missing ? add_columns<Lanes, all_rows, true>(*block, columns)
                                      : add_columns<Lanes, all_rows, false>(*block, columns);
  }
};

/// Adds the rows of a block.
/// @return how many times kLanes columns hold a missing pixel.
template <class Columns>
Index add_rows(numerics::Instructions instructions, const Block& block, const Columns& columns) {
  MANO_ASSERT(block.n_rows > 0 && block.n_rows <= kRows);
  Index n_found = 0;
  if (block.n_rows == kRows) {
    numerics::run_in_lanes<AddColumns<true>>(instructions, &block, columns, &n_found);
  } else {
    numerics::run_in_lanes<AddColumns<false>>(instructions, &block, columns, &n_found);
  }
  return n_found;
}

}  // namespace manoscope::maps::linear
