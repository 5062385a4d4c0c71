#include "manoscope/inversion/simultaneous_band.hpp"

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <numbers>
#include <vector>

namespace manoscope::inversion {
namespace {

/// Angles between the errors' unit vectors of neighbouring stations, summed up.
double length_of_curve(const PressureReading& reading, const std::vector<Index>& stations) {
  const Array1 standard = reading.uncertainty.standard();
  double length = 0.0;
  for (std::size_t a = 1; a < stations.size(); ++a) {
    const Index i = stations[a - 1], j = stations[a];
    double shared = 0.0;
    for (const ErrorMode& mode : reading.uncertainty.modes) {
      shared += mode.effect[i] * mode.effect[j];
    }
    length += std::acos(std::clamp(shared / (standard[i] * standard[j]), -1.0, 1.0));
  }
  return length;
}

}  // namespace

double simultaneous_factor(const PressureReading& reading, double coverage) {
  const boost::math::normal normal;
  const Array1 standard = reading.uncertainty.standard();
  std::vector<Index> stations;
  for (Index i = 0; i < reading.x.size(); ++i) {
    if (reading.answered(i) && standard[i] > 0.0) stations.push_back(i);
  }
  if (stations.empty()) return 0.0;
  const double each = std::pow(coverage, 1.0 / static_cast<double>(stations.size()));
  const double most = boost::math::quantile(normal, 0.5 * (1.0 + each));
  const double length = length_of_curve(reading, stations);
  const auto leaves = [&](double k) {
    return length / std::numbers::pi * std::exp(-0.5 * k * k) +
           2.0 * boost::math::cdf(boost::math::complement(normal, k));
  };
  double low = boost::math::quantile(normal, 0.5 * (1.0 + coverage)), high = most;
  if (leaves(high) > 1.0 - coverage) return most;
  for (int n = 0; n < 60 && high - low > 1e-9 * high; ++n) {
    const double middle = 0.5 * (low + high);
    (leaves(middle) > 1.0 - coverage ? low : high) = middle;
  }
  return high;
}

}  // namespace manoscope::inversion
