#include "manoscope/numerics/ranks.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "manoscope/core/error.hpp"

namespace manoscope::numerics {
namespace {

/// Which of the equal parts of a range a value falls into; grows with the value.
class Parts {
 public:
  static constexpr std::int32_t kCount = 256;

  explicit Parts(Range range) : range_(range), per_part_(kCount / (range.high - range.low)) {}

  std::int32_t of(double value) const {
    const double inside = std::min(std::max(value, range_.low), range_.high);
    return std::min(static_cast<std::int32_t>((inside - range_.low) * per_part_), kCount - 1);
  }
  double begin(std::int32_t part) const {
    return range_.low + static_cast<double>(part) / per_part_;
  }

 private:
  Range range_;
  double per_part_;
};

/// Parts that hold two ranks, and how many values lie in the parts before the first.
struct Found {
  std::int32_t lower, upper;
  std::size_t before;
};

Found find_parts(std::span<const double> values, const Parts& parts, std::size_t lower,
                 std::size_t upper) {
  std::array<std::uint32_t, Parts::kCount> count{};
  for (const double value : values) ++count[static_cast<std::size_t>(parts.of(value))];
  Found found{0, 0, 0};
  std::size_t n = count[0];
  while (n <= lower) {
    found.before = n;
    n += count[static_cast<std::size_t>(++found.lower)];
  }
  found.upper = found.lower;
  while (n <= upper) n += count[static_cast<std::size_t>(++found.upper)];
  return found;
}

/// Moves the values that `is_kept` to the front; without a branch on what they are.
template <class Predicate>
std::span<double> keep(std::span<double> values, const Predicate& is_kept) {
  std::size_t n = 0;
  for (const double value : values) {
    values[n] = value;
    n += static_cast<std::size_t>(is_kept(value));
  }
  return values.first(n);
}

/// Whether a range can be parted without leaving the range of numbers.
bool can_part(Range range) { return range.high - range.low > 1e-290; }

}  // namespace

Range values_of_ranks(std::span<double> values, std::size_t lower, std::size_t upper,
                      Range within) {
  MANO_ASSERT(lower <= upper && upper < values.size());
  constexpr std::size_t kFew = 512;  // not worth counting
  std::size_t n_below = 0, n_within = 0;
  for (const double value : values) {
    n_below += static_cast<std::size_t>(value < within.low);
    n_within += static_cast<std::size_t>(value >= within.low) &
                static_cast<std::size_t>(value <= within.high);
  }
  if (n_below <= lower && upper < n_below + n_within) {
    values = keep(values, [&](double value) {
      return static_cast<int>(value >= within.low) & static_cast<int>(value <= within.high);
    });
    lower -= n_below;
    upper -= n_below;
  }
  if (values.size() > kFew && can_part(within)) {
    const Parts parts(within);
    const Found found = find_parts(values, parts, lower, upper);
    values = keep(values, [&](double value) {
      const std::int32_t part = parts.of(value);
      return static_cast<int>(part >= found.lower) & static_cast<int>(part <= found.upper);
    });
    lower -= found.before;
    upper -= found.before;
  }
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(upper);
  std::nth_element(values.begin(), at, values.end());
  return {lower == upper ? *at : *std::max_element(values.begin(), at), *at};
}

std::optional<Range> range_of_ranks(std::span<const double> values, std::size_t lower,
                                    std::size_t upper, Range within) {
  MANO_ASSERT(lower <= upper && upper < values.size());
  if (!can_part(within)) return std::nullopt;
  const Parts parts(within);
  const Found found = find_parts(values, parts, lower, upper);
  if (found.lower == 0 || found.upper == Parts::kCount - 1) return std::nullopt;
  // A part more on either side: what lies on its end may count to the next by rounding.
  return Range{parts.begin(found.lower - 1), parts.begin(found.upper + 2)};
}

}  // namespace manoscope::numerics
