#include "manoscope/wall/line_load.hpp"

#include <algorithm>

#include "manoscope/core/error.hpp"

namespace manoscope::wall {

Matrix station_weights(const HermiteAxis& axis, const Array1& stations) {
  MANO_ASSERT(stations.size() >= 1);
  // Three points are exact for the product of a cubic and a straight line.
  constexpr std::array<double, 3> kPoint = {0.11270166537925831, 0.5, 0.88729833462074169};
  constexpr std::array<double, 3> kWeight = {5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0};
  const Index n = stations.size();
  Matrix weights = Matrix::Zero(2 * axis.n_nodes(), n);
  for (Index cell = 0; cell < axis.n_cells(); ++cell) {
    double from = axis.node(cell);
    while (from < axis.node(cell + 1)) {
      // The stations before and after this piece, none beyond the first and the last.
      const double* begin = stations.data();
      const Index after = std::upper_bound(begin, begin + n, from) - begin;
      const double to =
          after < n ? std::min(stations(after), axis.node(cell + 1)) : axis.node(cell + 1);
      for (std::size_t k = 0; k < 3; ++k) {
        const double at = from + kPoint[k] * (to - from);
        const HermiteValues value = hermite(axis.local(cell, at), axis.size(cell), 0);
        double share = 1.0;  // of the station after
        if (after > 0 && after < n) {
          share = (at - stations(after - 1)) / (stations(after) - stations(after - 1));
        }
        for (int f = 0; f < 4; ++f) {
          const double part = kWeight[k] * (to - from) * value[f];
          if (after == n) {
            weights(2 * cell + f, n - 1) += part;
            continue;
          }
          weights(2 * cell + f, after) += part * share;
          if (after > 0) weights(2 * cell + f, after - 1) += part * (1.0 - share);
        }
      }
      from = to;
    }
  }
  return weights;
}

Eigen::VectorXd sampling_weights(const HermiteAxis& axis, double position) {
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(2 * axis.n_nodes());
  const Index cell = axis.cell_of(position);
  const HermiteValues value = hermite(axis.local(cell, position), axis.size(cell), 0);
  for (int f = 0; f < 4; ++f) weights(2 * cell + f) = value[f];
  return weights;
}

}  // namespace manoscope::wall
