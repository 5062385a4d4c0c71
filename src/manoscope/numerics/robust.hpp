#pragma once

#include <vector>

namespace manoscope::numerics {

/// Median; the mean of the middle two for an even count. The values are reordered.
/// @throws InternalError if there are none.
double median(std::vector<double>& values);

/// Standard deviation of a normal distribution with the same median absolute deviation about
/// `centre`: 1.4826 median |v - centre|. Half of the values may be arbitrarily wrong.
double mad_sigma(const std::vector<double>& values, double centre);

}  // namespace manoscope::numerics
