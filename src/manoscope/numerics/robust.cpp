#include "manoscope/numerics/robust.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "manoscope/core/error.hpp"

namespace manoscope::numerics {
namespace {

using Range = std::pair<std::size_t, std::size_t>;

/// Moves the values within a bracket about the median to the front: how many they are, and how many
/// values lie below. The bracket comes from a sample; for about one vector in 10^4, or one whose
/// order is in step with the sample, it misses the median.
Range gather_middle(std::vector<double>& values) {
  constexpr std::size_t kSample = 1023;
  constexpr std::size_t kReach = 64;  // in ranks of the sample: 4 standard deviations
  std::vector<double> sample(kSample);
  const std::size_t stride = values.size() / kSample;
  for (std::size_t i = 0; i < kSample; ++i) sample[i] = values[i * stride];
  std::sort(sample.begin(), sample.end());
  const double low = sample[kSample / 2 - kReach], high = sample[kSample / 2 + kReach];
  std::size_t n_middle = 0, n_below = 0;
  for (double& value : values) {
    if (value < low) ++n_below;
    if (value >= low && value <= high) std::swap(value, values[n_middle++]);
  }
  return {n_middle, n_below};
}

/// The mean of the values of rank `lower` and `upper`, equal or neighbours, among the first n.
double middle_value(std::vector<double>& values, std::size_t n, std::size_t lower,
                    std::size_t upper) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(upper);
  std::nth_element(values.begin(), at, values.begin() + static_cast<std::ptrdiff_t>(n));
  return lower == upper ? *at : 0.5 * (*at + *std::max_element(values.begin(), at));
}

}  // namespace

double median(std::vector<double>& values) {
  MANO_ASSERT(!values.empty());
  // Selecting among the few values near the median costs a fifth of selecting among all.
  constexpr std::size_t kMany = 8192;
  const std::size_t n = values.size(), lower = (n - 1) / 2, upper = n / 2;
  if (n >= kMany) {
    const auto [n_middle, n_below] = gather_middle(values);
    if (n_below <= lower && upper < n_below + n_middle) {
      return middle_value(values, n_middle, lower - n_below, upper - n_below);
    }
  }
  return middle_value(values, n, lower, upper);
}

double mad_sigma(const std::vector<double>& values, double centre) {
  constexpr double kNormalConsistency = 1.482602218505602;  // 1 / quantile(3/4)
  std::vector<double> deviations(values.size());
  std::transform(values.begin(), values.end(), deviations.begin(),
                 [centre](double value) { return std::abs(value - centre); });
  return kNormalConsistency * median(deviations);
}

}  // namespace manoscope::numerics
