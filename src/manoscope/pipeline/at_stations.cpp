#include "manoscope/pipeline/at_stations.hpp"

#include <algorithm>
#include <vector>

#include "manoscope/results/no_number.hpp"

namespace manoscope::pipeline {

Array1 between(const Array1& from, const Array1& values, const Array1& x) {
  Array1 result = Array1::Constant(x.size(), results::kNoNumber);
  if (from.size() < 2) return result;
  const auto* const begin = from.data();
  for (Index i = 0; i < x.size(); ++i) {
    if (x[i] < from[0] || x[i] > from[from.size() - 1]) continue;
    const Index right = std::clamp<Index>(
        std::upper_bound(begin, begin + from.size(), x[i]) - begin, 1, from.size() - 1);
    const double share = (x[i] - from[right - 1]) / (from[right] - from[right - 1]);
    result[i] = (1.0 - share) * values[right - 1] + share * values[right];
  }
  return result;
}

Array1 answers_between(const inversion::PressureReading& reading, const Array1& values,
                       const Array1& x) {
  std::vector<double> at, value;
  for (Index i = 0; i < reading.x.size(); ++i) {
    if (!reading.answered(i)) continue;
    at.push_back(reading.x[i]);
    value.push_back(values[i]);
  }
  const auto n = static_cast<Index>(at.size());
  return between(Eigen::Map<const Array1>(at.data(), n), Eigen::Map<const Array1>(value.data(), n),
                 x);
}

}  // namespace manoscope::pipeline
