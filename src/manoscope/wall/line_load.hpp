#pragma once

#include "manoscope/wall/hermite_grid.hpp"

namespace manoscope::wall {

/// Integrals of the Hermite functions of an axis with the piecewise linear functions of stations.
///
/// Column j belongs to the function that is 1 at station j, 0 at the others, linear between them
/// and constant beyond the first and the last. Row 2 i is the value function of node i, row 2 i + 1
/// its slope function. Exact: cells are split at the stations. The columns sum to the integrals
/// with 1, so a pressure p at the stations loads the wall with the matrix times p.
/// @param stations  (n), n >= 1, strictly ascending, in the axis' unit.
Matrix station_weights(const HermiteAxis& axis, const Array1& stations);

/// Values of the Hermite functions at one position, in the same order of rows.
Eigen::VectorXd sampling_weights(const HermiteAxis& axis, double position);

}  // namespace manoscope::wall
