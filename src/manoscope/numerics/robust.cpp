#include "manoscope/numerics/robust.hpp"

#include <algorithm>
#include <cmath>

#include "manoscope/core/error.hpp"

namespace manoscope::numerics {

double median(std::vector<double>& values) {
  MANO_ASSERT(!values.empty());
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return 0.5 * (*middle + *std::max_element(values.begin(), middle));
}

double mad_sigma(const std::vector<double>& values, double centre) {
  constexpr double kNormalConsistency = 1.482602218505602;  // 1 / quantile(3/4)
  std::vector<double> deviations(values.size());
  std::transform(values.begin(), values.end(), deviations.begin(),
                 [centre](double value) { return std::abs(value - centre); });
  return kNormalConsistency * median(deviations);
}

}  // namespace manoscope::numerics
