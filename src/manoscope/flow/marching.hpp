#pragma once

#include <vector>

#include "manoscope/core/arrays.hpp"

namespace manoscope::flow {

/// Velocity profile where a march begins.
enum class InletProfile {
  developed,  ///< that of a long duct with the section of the first station
  uniform,    ///< the same speed everywhere: the flow begins to develop here
};

/// What a march met on its way. Bits per station; 0 = good.
struct MarchFlag {
  /// Flow back along a wall here. The convection of the backflow is left out (FLARE), so that the
  /// march goes on, but here and downstream its answer is a guess.
  static constexpr FlagBits separated = 1;
  /// Downstream of a separation.
  static constexpr FlagBits after_separation = 2;
  /// The march broke down somewhere: no pressure, NaN at every station.
  static constexpr FlagBits no_answer = 4;
};

/// Weights of the implicit derivative at the last of three stations: f' = now f_i + before f_{i-1}
/// + earlier f_{i-2}.
///
/// Second order on any spacing (variable-step BDF2); the first step is backward Euler. Source:
/// Hairer, Norsett & Wanner, Solving Ordinary Differential Equations I (1993), ch. III.5.
struct BackwardDerivative {
  double now = 0.0, before = 0.0, earlier = 0.0;

  /// @param step      x_i - x_{i-1} > 0
  /// @param previous  x_{i-1} - x_{i-2} > 0, or 0 at the first step
  static BackwardDerivative of(double step, double previous) {
    if (previous == 0.0) return {1.0 / step, -1.0 / step, 0.0};
    const double ratio = step / previous;
    return {(1.0 + 2.0 * ratio) / (1.0 + ratio) / step, -(1.0 + ratio) / step,
            ratio * ratio / (1.0 + ratio) / step};
  }
};

/// Stations of a march from stations of a measurement.
struct MarchGrid {
  Array1 x;                     ///< (n) m
  Array1 place;                 ///< (n) index among the stations given, with fraction
  std::vector<Index> stations;  ///< where each station given is in x
};

/// The stations given, with graded ones in the first interval for a profile that starts uniform.
///
/// The boundary layer grows as the root of x from nothing: steps grow by a quarter from 1e-6 of the
/// development length Re h to the spacing of the stations.
/// @param x         (n) m, strictly ascending, n >= 2.
/// @param inlet     developed leaves the stations as they are.
/// @param development_length  mean speed times h^2/nu, m.
/// @throws InputError if x does not ascend or holds fewer than two stations.
MarchGrid march_grid(const Array1& x, InletProfile inlet, double development_length);

/// Values at the stations given, linear between them, on the grid of the march.
Array1 on_grid(const MarchGrid& grid, const Array1& values);

/// Marks what lies downstream of the first separated station.
void flag_downstream(Flags1& flags);

}  // namespace manoscope::flow
