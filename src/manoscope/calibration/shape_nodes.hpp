#pragma once

#include <vector>

#include "manoscope/core/index.hpp"

namespace manoscope::calibration {

/// A level of one stretch as interpolation sees it.
struct ShapeLevel {
  Index level;
  double average;  ///< m, of the deflection across the width
};

/// Levels to read a shape of that average off: those on either side and one more beyond each (two
/// beyond one where the other is the last), no two nearer to each other than half the distance of
/// the inner two, so that noise is not blown up.
///
/// @param levels  in order of pressure. Averages that fall with pressure by less than 2 % of their
///                range change places; where they fall by more the wall has several shapes of one
///                average, and there is no answer.
/// @return three or four levels, ascending in their average; none also outside the levels, or with
///         fewer than three of them.
std::vector<Index> shape_nodes(const std::vector<ShapeLevel>& levels, double average);

/// The polynomial through nodes at one place.
struct NodeWeights {
  std::vector<double> weight;
  std::vector<double> growth;  ///< d weight / d place
  /// In the difference to another fair interpolant, without the last or the first node.
  std::vector<double> other_low, other_high;
};

/// @param places  of the nodes, no two alike.
NodeWeights node_weights(const std::vector<double>& places, double at);

}  // namespace manoscope::calibration
