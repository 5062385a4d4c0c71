#pragma once

#include <cstddef>
#include <optional>
#include <span>

namespace manoscope::numerics {

/// Lower and upper end of a range.
struct Range {
  double low, high;
};

/// The values of rank `lower` and `upper`, counted from 0; equal, or neighbours.
///
/// Counts first how many values fall into each of 256 equal parts of the range and selects among
/// those of one part alone: an eighth of the time of std::nth_element among thousands that lie
/// about evenly. The result does not depend on the order of the values.
/// @param values  are overwritten.
/// @param within  where those about the ranks lie, for speed alone.
Range values_of_ranks(std::span<double> values, std::size_t lower, std::size_t upper, Range within);

/// A range that holds the values of rank `lower` to `upper`, to one of 256 equal parts of `within`.
/// Values beyond that count at its ends.
/// @return nullopt if a rank lies there: the range is not known.
std::optional<Range> range_of_ranks(std::span<const double> values, std::size_t lower,
                                    std::size_t upper, Range within);

}  // namespace manoscope::numerics
