#pragma once

#include <array>

#include "manoscope/core/arrays.hpp"

namespace manoscope::navier_stokes {

/// A place on a smooth curve through stations, as weights of those around it.
///
/// Cubic Hermite between neighbours, the slope at a station that of the polynomial through the five
/// nearest (all, where there are fewer): C1, exact for polynomials of third degree, error of order
/// spacing^4 for smooth shapes. Noise is not smoothed away.
struct SmoothStencil {
  static constexpr Index kMost = 6;

  Index first = 0, n = 0;              ///< stations first .. first + n - 1
  std::array<double, kMost> weight{};  ///< of each

  /// @param stations  (m) strictly ascending, m >= 2.
  /// @param at        taken to the nearer end where it lies outside.
  SmoothStencil(const Array1& stations, double at);

  /// The curve at the place, from values (m) at the stations.
  double value(const Array1& values) const {
    double sum = 0.0;
    for (Index i = 0; i < n; ++i) sum += weight[static_cast<std::size_t>(i)] * values[first + i];
    return sum;
  }
};

/// (m) weights of the stations in the mean of the curve from the first to the last.
Array1 mean_weights(const Array1& stations);

}  // namespace manoscope::navier_stokes
