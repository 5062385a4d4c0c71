#include "manoscope/io/even_axis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "manoscope/core/error.hpp"
#include "manoscope/io/file_units.hpp"

namespace manoscope::io {
namespace {

/// Departure of a coordinate from even spacing, in parts of the whole length, that round-off of
/// 32-bit coordinates explains (6e-8) but a missing pixel does not (1e-5 at 1e5 pixels).
constexpr double kSpacingTolerance = 1e-6;

}  // namespace

double even_step(std::span<const double> x, const std::string& where) {
  const bool numbers = x.size() > 1 && std::all_of(x.begin(), x.end(), [](double value) {
                         return std::isfinite(value) && std::abs(value) < kLargestValue;
                       });
  const double length = numbers ? x.back() - x.front() : 0.0;
  if (!(length > 0.0)) {
    throw InputError(where, "the coordinate does not rise from its first to its last value",
                     "Store coordinates in ascending order, without gaps");
  }
  const double step = length / static_cast<double>(x.size() - 1);
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double even = x.front() + static_cast<double>(i) * step;
    if (std::abs(x[i] - even) > kSpacingTolerance * length) {
      throw InputError(
          where, fmt::format("value {} is {:.8g}, but even spacing asks for {:.8g}", i, x[i], even),
          "Resample the map to evenly spaced pixels");
    }
  }
  return step;
}

}  // namespace manoscope::io
