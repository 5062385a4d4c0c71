#pragma once

#include <array>
#include <vector>

#include "manoscope/core/grid.hpp"

namespace manoscope::maps {

/// What the straight line between samples at `a` < `b` contributes to the integral over
/// [low, high]: the weights of the two samples.
std::array<double, 2> line_weights(double a, double b, double low, double high);

/// Weights of the trapezoid rule (1/w) int_{-w/2}^{w/2} dz for a column without a bad pixel.
struct ColumnWeights {
  ColumnWeights(const ChannelGrid& grid, double width);

  /// False where the map does not reach beyond both edges, or shows fewer than two rows between.
  bool exist = false;
  Index first = 0, last = -1;  ///< rows: those inside the channel and the one beyond either edge
  std::vector<double> weight;  ///< of the rows from `first` to `last`
  double sum = 0.0, squares = 0.0;
  double mean_z = 0.0;  ///< m, where the weights balance

  double of(Index iz) const { return weight[static_cast<std::size_t>(iz - first)]; }
};

/// What the gaps of one column change in its weights, gap by gap along growing rows. A missing
/// pixel counts 0 in the sum that the full weights make.
class ColumnGaps {
 public:
  double measured = 0.0;  ///< added to the sum of the weights of pixels
  double mean_z = 0.0;    ///< m, added to the sum of weight times z
  double squares = 0.0;   ///< added to the sum of the squares
  double sixth = 0.0;     ///< m6, sum of the gaps' widths to the sixth power

  /// A row loses its weight.
  void remove(const ColumnWeights& full, const ChannelGrid& grid, Index iz);
  /// A row's weight grows.
  void grow(const ColumnWeights& full, const ChannelGrid& grid, Index iz, double by);
  /// The pixels between two good ones, both inside the channel, are missing.
  /// @return by how much the weights of these two grow.
  double close(const ColumnWeights& full, const ChannelGrid& grid, Index lower, Index upper,
               double width);

 private:
  Index grown_row_ = -1;  ///< of the gap before, and by how much it has grown
  double grown_ = 0.0;
};

}  // namespace manoscope::maps
