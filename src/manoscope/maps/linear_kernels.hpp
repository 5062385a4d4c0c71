// Sums over the rows of a map, some rows and eight columns at a time: the inside of LinearPass.
#pragma once

#include <array>
#include <cmath>
#include <cstring>

#include "manoscope/core/arrays.hpp"
#include "manoscope/numerics/lanes.hpp"

namespace manoscope::maps::linear {

using numerics::kLanes;

/// Rows taken in at a time: sums are fetched and put back once for all of them.
inline constexpr Index kRows = 8, kFewRows = 4;

inline Index whole_lanes(Index n) { return (n + kLanes - 1) / kLanes * kLanes; }

/// A few rows, and the columns to look at, in whole lanes. A missing pixel counts 0 and its place,
/// row times `stride` plus column, goes to `missing`.
struct Block {
  const char* rows;
  Index n_rows, row_bytes, first, end, stride;
  Index* missing;
  Index* n_missing;
};

/// Lists the missing ones of kLanes pixels of row r.
inline void list_missing(const Block& block, Index r, Index ix) {
  for (Index k = ix; k < ix + kLanes; ++k) {
    std::uint32_t bits = 0;
    std::memcpy(&bits, block.rows + r * block.row_bytes + 4 * k, sizeof bits);
    block.missing[*block.n_missing] = r * block.stride + k;
    *block.n_missing += static_cast<Index>((bits & 0x7f800000U) == 0x7f800000U);
  }
}

/// Whether a column of lanes holds a missing pixel; by whole numbers alone, for a signalling NaN
/// must not be touched as a float.
template <class Lanes, Index n_rows>
[[gnu::always_inline]] inline bool any_missing(const char* at, Index row_bytes) {
  typename Lanes::FloatBits largest{};
  for (Index r = 0; r < n_rows; ++r) Lanes::raise(largest, at + r * row_bytes);
  return Lanes::any_not_finite(largest);
}

/// Calls `add(column, pixels)` for every column of lanes; `pixels(r)` are those of its row r.
template <class Lanes, Index n_rows, class Add>
[[gnu::always_inline]] inline void for_each_column(const Block& block, const Add& add) {
  const char* const rows = block.rows;
  const Index row_bytes = block.row_bytes, end = block.end;
  for (Index ix = block.first; ix < end; ix += kLanes) {
    const char* const at = rows + 4 * ix;
    if (any_missing<Lanes, n_rows>(at, row_bytes)) [[unlikely]] {
      add(
          ix, [&](Index r) __attribute__((always_inline)) {
            return Lanes::finite_floats(at + r * row_bytes);
          });
      for (Index r = 0; r < n_rows; ++r) {
        if (any_missing<Lanes, 1>(at + r * row_bytes, 0)) list_missing(block, r, ix);
      }
    } else {
      add(
          ix, [&](Index r)
                  __attribute__((always_inline)) { return Lanes::floats(at + r * row_bytes); });
    }
  }
}

/// sum += weight height, a column.
template <Index n_rows>
struct WeightedColumns {
  template <class Lanes>
  [[gnu::always_inline]] static void run(const Block* block, const double* weight, double* sums) {
    double w[n_rows];
    std::memcpy(w, weight, sizeof w);
    const auto add = [&](Index ix, const auto& pixels) __attribute__((always_inline)) {
      Lanes sum = Lanes::load(sums + ix);
      for (Index r = 0; r < n_rows; ++r) sum = sum + Lanes::all(w[r]) * pixels(r);
      sum.store(sums + ix);
    };
    for_each_column<Lanes, n_rows>(*block, add);
  }
};

/// Columns of sums over the rim: of heights, of b times height, of their squares.
struct Moments {
  std::vector<double> height, b_height, square;

  explicit Moments(Index n) { reset(n); }
  void reset(Index n) {
    for (auto* list : {&height, &b_height, &square}) list->assign(static_cast<std::size_t>(n), 0.0);
  }
};

template <Index n_rows>
struct MomentColumns {
  template <class Lanes>
  [[gnu::always_inline]] static void run(const Block* block, const double* b, double* height,
                                         double* b_height, double* square) {
    double at_b[n_rows];
    std::memcpy(at_b, b, sizeof at_b);
    const auto add = [&](Index ix, const auto& pixels) __attribute__((always_inline)) {
      Lanes sum = Lanes::load(height + ix), b_sum = Lanes::load(b_height + ix);
      Lanes squares = Lanes::load(square + ix);
      for (Index r = 0; r < n_rows; ++r) {
        const Lanes h = pixels(r);
        sum = sum + h;
        b_sum = b_sum + Lanes::all(at_b[r]) * h;
        squares = squares + h * h;
      }
      sum.store(height + ix);
      b_sum.store(b_height + ix);
      squares.store(square + ix);
    };
    for_each_column<Lanes, n_rows>(*block, add);
  }
};

/// Kernel<n>, n the number of rows: 1, kFewRows or kRows.
template <template <Index> class Kernel, class... Arguments>
void run_rows(numerics::Instructions instructions, const Block& block, Arguments... arguments) {
  if (block.n_rows == kRows) {
    numerics::run_in_lanes<Kernel<kRows>>(instructions, &block, arguments...);
  } else if (block.n_rows == kFewRows) {
    numerics::run_in_lanes<Kernel<kFewRows>>(instructions, &block, arguments...);
  } else {
    numerics::run_in_lanes<Kernel<1>>(instructions, &block, arguments...);
  }
}

}  // namespace manoscope::maps::linear
