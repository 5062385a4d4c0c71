#include "smooth_stencil.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "manoscope/core/error.hpp"

namespace manoscope::navier_stokes {
namespace {

/// Adds, times `share`, the weights of the slope at station `at` of the polynomial through the five
/// nearest.
void add_slope(const Array1& x, Index at, double share, SmoothStencil& stencil) {
  constexpr Index kNeighbours = 5;
  const Index count = std::min(kNeighbours, x.size());
  const Index first = std::clamp<Index>(at - count / 2, 0, x.size() - count);
  const auto weight = [&](Index j) -> double& {
    return stencil.weight[static_cast<std::size_t>(j - stencil.first)];
  };
  for (Index j = first; j < first + count; ++j) {
    if (j == at) continue;
    double ratio = 1.0 / (x[j] - x[at]);  // of the products in Lagrange's basis polynomial j
    for (Index k = first; k < first + count; ++k) {
      if (k != j && k != at) ratio *= (x[at] - x[k]) / (x[j] - x[k]);
    }
    weight(j) += share * ratio;
    weight(at) -= share * ratio;
  }
}

}  // namespace

SmoothStencil::SmoothStencil(const Array1& stations, double at) {
  const Index m = stations.size();
  MANO_ASSERT(m >= 2);
  const Index above = std::upper_bound(stations.begin(), stations.end(), at) - stations.begin();
  const Index i = std::clamp<Index>(above - 1, 0, m - 2);
  n = std::min(kMost, m);
  first = std::clamp<Index>(i - 2, 0, m - n);
  const double step = stations[i + 1] - stations[i];
  const double s = std::clamp((at - stations[i]) / step, 0.0, 1.0), rest = 1.0 - s;
  weight[static_cast<std::size_t>(i - first)] += rest * rest * (1.0 + 2.0 * s);
  weight[static_cast<std::size_t>(i + 1 - first)] += s * s * (3.0 - 2.0 * s);
  add_slope(stations, i, rest * rest * s * step, *this);
  add_slope(stations, i + 1, -s * s * rest * step, *this);
}

Array1 mean_weights(const Array1& stations) {
  const Index m = stations.size();
  Array1 weights = Array1::Zero(m);
  const double length = stations[m - 1] - stations[0];
  for (Index i = 0; i + 1 < m; ++i) {
    const double step = stations[i + 1] - stations[i];
    const double middle = stations[i] + 0.5 * step;
    // Gauss' rule of two points, exact for cubics.
    for (const double side : {-0.5, 0.5}) {
      const SmoothStencil stencil(stations, middle + side * step / std::numbers::sqrt3);
      for (Index k = 0; k < stencil.n; ++k) {
        weights[stencil.first + k] +=
            0.5 * step / length * stencil.weight[static_cast<std::size_t>(k)];
      }
    }
  }
  return weights;
}

}  // namespace manoscope::navier_stokes
