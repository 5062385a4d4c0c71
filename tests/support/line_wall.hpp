#pragma once

#include <cmath>
#include <vector>

#include "manoscope/core/arrays.hpp"

namespace manoscope::test {

/// A wall that obeys the tube law exactly, held at both ends:
///
///   p(x) = a zeta + c zeta^3 + b zeta'',  zeta(0) = zeta(l) = 0
///
/// (pascals and metres), solved by central differences and Newton's method on 3200 cells: with a
/// healing length L of a thirtieth of l the error is (h/L)^2/12, 1e-5 of zeta.
struct LineWall {
  double length = 8e-3;
  double a = 1e8, c = 1.2e18;  ///< Pa/m, Pa/m3
  double b = -6.25;            ///< N/m: L = 0.25 mm

  static constexpr Index kCells = 3200;
  double cell() const { return length / static_cast<double>(kCells); }
  /// Inner nodes of the solution, (kCells - 1) m.
  static Array1 nodes_of(double length) {
    const double cell = length / static_cast<double>(kCells);
    return Array1::LinSpaced(kCells - 1, cell, length - cell);
  }

  /// Deflection at the nodes under a pressure at the nodes.
  Array1 solve(const Array1& p) const {
    const Index n = kCells - 1;
    const double coupling = b / (cell() * cell());
    Array1 z = p / a;
    for (int step = 0; step < 60; ++step) {
      Array1 left(n), diagonal(n);
      for (Index i = 0; i < n; ++i) {
        const double before = i > 0 ? z[i - 1] : 0.0, behind = i + 1 < n ? z[i + 1] : 0.0;
        left[i] =
            p[i] - a * z[i] - c * z[i] * z[i] * z[i] - coupling * (before - 2.0 * z[i] + behind);
        diagonal[i] = a + 3.0 * c * z[i] * z[i] - 2.0 * coupling;
      }
      // Thomas's algorithm.
      for (Index i = 1; i < n; ++i) {
        const double factor = coupling / diagonal[i - 1];
        diagonal[i] -= factor * coupling;
        left[i] -= factor * left[i - 1];
      }
      Array1 change(n);
      for (Index i = n - 1; i >= 0; --i) {
        change[i] = (left[i] - (i + 1 < n ? coupling * change[i + 1] : 0.0)) / diagonal[i];
      }
      z += change;
      if (change.abs().maxCoeff() < 1e-16) break;
    }
    return z;
  }
  /// Values at stations from those at the nodes, the latter being every m-th node.
  static Array1 at_stations(const Array1& nodes, Index every) {
    Array1 result(nodes.size() / every);
    for (Index i = 0; i < result.size(); ++i) result[i] = nodes[i * every + every / 2];
    return result;
  }
};

}  // namespace manoscope::test
