#include "manoscope/maps/cut_sections.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "manoscope/core/flags.hpp"
#include "manoscope/maps/column_weights.hpp"

namespace manoscope::maps {
namespace {

constexpr double kStretch = 0.125;  // widths
constexpr Index kMostBins = 16, kFewestBins = 8;
constexpr double kFewestPixels = 3.0;                       // a bin
constexpr double kMarginShare = 0.02, kMarginPixels = 1.5;  // left out at either side
constexpr double kLongestGap = 0.1, kGapPixels = 2.5;       // widths; at least
constexpr double kSpike = 10.0;      // deviations of the noise: eight of a pixel against two others
constexpr double kRoundOff = 1e-12;  // m
constexpr double kWhole = 0.999;     // of a cell, bridged pixels included

/// Where stretches and bins lie.
struct Layout {
  Index first_column = 0;
  std::vector<Index> ends;  ///< columns of stretch j: [ends[j], ends[j + 1]), from first_column
  Array1 x;
  Array1 edges;  ///< (n_z + 1) m, of the bins, from the wall's middle

  Layout(const ChannelGrid& grid, double length, double width) {
    while (first_column < grid.nx && grid.x(first_column) < 0.0) ++first_column;
    Index end = first_column;
    while (end < grid.nx && grid.x(end) <= length) ++end;
    const Index n_columns = end - first_column;
    const double pitch = grid.pitch_z.si();
    const double inner = width - 2.0 * std::max(kMarginShare * width, kMarginPixels * pitch);
    const auto n_bins =
        std::min<Index>(kMostBins, static_cast<Index>(inner / (kFewestPixels * pitch)));
    if (n_bins < kFewestBins || n_columns < 2) return;
    edges = Array1::LinSpaced(n_bins + 1, -0.5 * inner, 0.5 * inner);
    const auto n = std::clamp<Index>(static_cast<Index>(std::lround(length / (kStretch * width))),
                                     1, n_columns);
    x = Array1(n);
    for (Index j = 0; j <= n; ++j) ends.push_back(j * n_columns / n);
    for (Index j = 0; j < n; ++j) {
      x[j] = grid.x(first_column) +
             0.5 * grid.pitch_x.si() * static_cast<double>(begin(j) + begin(j + 1) - 1);
    }
  }
  Index begin(Index stretch) const { return ends[static_cast<std::size_t>(stretch)]; }
  Index n_x() const { return x.size(); }
  Index n_z() const { return edges.size() - 1; }
};

/// One row of pixels stretch by stretch.
struct RowSums {
  Array1 height;  ///< m, sum over the pixels, bridged ones included
  Array1 count;
  Array1 gain;  ///< variance of the sum for unit noise of a pixel
  Array1 sag;   ///< m2: times the curvature, what the bridges miss in the sum
};

class RowReader {
 public:
  RowReader(const DeflectionMap& map, const Layout& layout, double longest_gap, double spike)
      : map_(map), layout_(layout), longest_(longest_gap), spike_(spike), n_(layout.ends.back()) {
    bad_.resize(static_cast<std::size_t>(n_));
    sums_.height = sums_.count = sums_.gain = sums_.sag = Array1::Zero(layout.n_x());
    for (Index j = 0; j < layout.n_x(); ++j) {
      stretch_.insert(stretch_.end(),
                      static_cast<std::size_t>(layout.begin(j + 1) - layout.begin(j)), j);
    }
  }

  const RowSums& read(Index iz) {
    const double* const height = &map_.zeta()(iz, layout_.first_column);
    find_bad(height, &map_.flags()(iz, layout_.first_column));
    const FlagBits* const flags = bad_.data();
    for (Index j = 0; j < layout_.n_x(); ++j) {
      double sum = 0.0, count = 0.0;
      for (Index i = layout_.begin(j); i < layout_.begin(j + 1); ++i) {
        const double good = flags[i] == 0 ? 1.0 : 0.0;
        sum += good * height[i];
        count += good;
      }
      sums_.height[j] = sum;
      sums_.count[j] = sums_.gain[j] = count;
    }
    sums_.sag.setZero();
    for (Index i = 0; i < n_; ++i) {
      if (flags[i] == 0) continue;
      Index end = i + 1;
      while (end < n_ && flags[end] != 0) ++end;
      bridge(height, i - 1, end);
      i = end;
    }
    return sums_;
  }

 private:
  /// Flagged pixels, and those that stand off the straight line between the next good ones in their
  /// row, and between the second next, by more than these two lie apart and `spike_`: along the
  /// flow the wall is smooth.
  void find_bad(const double* height, const FlagBits* flags) {
    std::copy(flags, flags + n_, bad_.begin());
    good_.clear();
    for (Index i = 0; i < n_; ++i) {
      if (flags[i] == 0) good_.push_back(i);
    }
    for (std::size_t k = 2; k + 2 < good_.size(); ++k) {
      const Index i = good_[k];
      const auto line = [&](Index from, Index to) {
        const double share = static_cast<double>(i - from) / static_cast<double>(to - from);
        return height[from] + share * (height[to] - height[from]);
      };
      const double near = line(good_[k - 1], good_[k + 1]);
      const double off = std::abs(height[i] - near);
      if (off <= spike_) continue;
      const double far = line(good_[k - 2], good_[k + 2]);
      const double bound = spike_ + std::abs(near - far);
      if (off > bound && std::abs(height[i] - far) > bound) {
        bad_[static_cast<std::size_t>(i)] = PixelFlag::spike;
      }
    }
  }

  /// Pixels between two good ones take the straight line between them.
  void bridge(const double* height, Index before, Index after) {
    if (before < 0 || after >= n_) return;
    const auto steps = static_cast<double>(after - before);
    const double gap = steps * map_.grid().pitch_x.si();
    if (gap > longest_) return;
    const double step = (height[after] - height[before]) / steps;
    for (Index i = before + 1; i < after; ++i) {
      const Index j = stretch_[static_cast<std::size_t>(i)];
      sums_.height[j] += height[before] + step * static_cast<double>(i - before);
      sums_.count[j] += 1.0;
      // The weight of either neighbour grows from 1 by half the missing pixels.
      sums_.gain[j] += 2.0 + 0.5 * (steps - 1.0);
      sums_.sag[j] += gap * gap / 12.0;
    }
  }

  const DeflectionMap& map_;
  const Layout& layout_;
  double longest_, spike_;
  Index n_;
  std::vector<FlagBits> bad_;  ///< of each column
  std::vector<Index> good_;    ///< columns
  RowSums sums_;
  std::vector<Index> stretch_;  ///< of each column
};

/// Sums over cells of the rows' sums.
struct CellSums {
  Array2 height, found, wanted, gain, sag;

  explicit CellSums(const Layout& layout)
      : height(Array2::Zero(layout.n_z(), layout.n_x())),
        found(height),
        wanted(height),
        gain(height),
        sag(height) {}

  void add(Index bin, Index stretch, double share, const RowSums& row, double n_columns) {
    height(bin, stretch) += share * row.height[stretch];
    found(bin, stretch) += share * row.count[stretch];
    wanted(bin, stretch) += share * n_columns;
    gain(bin, stretch) += share * share * row.gain[stretch];
    sag(bin, stretch) += share * row.sag[stretch];
  }
};

CellSums sum_cells(const DeflectionMap& map, const Layout& layout, double length, double width,
                   double noise, const CentreLine& centre) {
  const ChannelGrid& grid = map.grid();
  const double pitch = grid.pitch_z.si(), bin = layout.edges[1] - layout.edges[0];
  const double reach = layout.edges[layout.n_z()] + centre.farthest(length) + pitch;
  RowReader reader(map, layout, std::max(kLongestGap * width, kGapPixels * grid.pitch_x.si()),
                   std::max(kSpike * noise, kRoundOff));
  CellSums cells(layout);
  for (Index iz = 0; iz < grid.nz; ++iz) {
    if (std::abs(grid.z(iz)) > reach) continue;
    const RowSums& row = reader.read(iz);
    for (Index j = 0; j < layout.n_x(); ++j) {
      const double z = grid.z(iz) - centre.z(layout.x[j], length);
      const auto n_columns = static_cast<double>(layout.begin(j + 1) - layout.begin(j));
      const auto low = static_cast<Index>(std::floor((z - pitch - layout.edges[0]) / bin));
      for (Index b = std::max<Index>(low, 0); b < layout.n_z() && layout.edges[b] < z + pitch;
           ++b) {
        const double from = layout.edges[b], to = layout.edges[b + 1];
        const double share =
            line_weights(z - pitch, z, from, to)[1] + line_weights(z, z + pitch, from, to)[0];
        if (share > 0.0) cells.add(b, j, share, row, n_columns);
      }
    }
  }
  return cells;
}

/// Second derivative along x by the parabola through a cell and its two neighbours; at the ends
/// that of the neighbour. Flagged cells are passed over.
Array2 curvature_along(const CrossSections& cut) {
  Array2 curvature = Array2::Zero(cut.zeta.rows(), cut.zeta.cols());
  for (Index b = 0; b < cut.zeta.rows(); ++b) {
    std::vector<Index> good;
    for (Index j = 0; j < cut.zeta.cols(); ++j) {
      if (cut.flags(b, j) == 0) good.push_back(j);
    }
    if (good.size() < 3) continue;
    for (std::size_t i = 0; i < good.size(); ++i) {
      const std::size_t middle = std::clamp<std::size_t>(i, 1, good.size() - 2);
      const Index before = good[middle - 1], at = good[middle], after = good[middle + 1];
      const double left = cut.x[at] - cut.x[before], right = cut.x[after] - cut.x[at];
      curvature(b, good[i]) = 2.0 *
                              ((cut.zeta(b, after) - cut.zeta(b, at)) / right -
                               (cut.zeta(b, at) - cut.zeta(b, before)) / left) /
                              (left + right);
    }
  }
  return curvature;
}

}  // namespace

CrossSections cut_sections(const DeflectionMap& map, Length channel_length, Length channel_width,
                           Length noise, const CentreLine& centre) {
  const double length = channel_length.si(), width = channel_width.si();
  const Layout layout(map.grid(), length, width);
  CrossSections cut;
  if (layout.n_x() == 0) return cut;
  cut.x = layout.x;
  cut.z = 0.5 * (layout.edges.head(layout.n_z()) + layout.edges.tail(layout.n_z()));
  const CellSums cells = sum_cells(map, layout, length, width, noise.si(), centre);
  const auto good = cells.found > kWhole * cells.wanted && cells.wanted > 0.0;
  cut.zeta = good.select(cells.height / cells.found.max(1e-300), 0.0);
  cut.flags = good.select(Flags2::Zero(layout.n_z(), layout.n_x()),
                          Flags2::Constant(layout.n_z(), layout.n_x(), PixelFlag::no_data));
  // Noise that reaches farther than a cell is one error of the whole cell.
  const double columns =
      static_cast<double>(layout.ends.back()) / static_cast<double>(layout.n_x());
  const double rows = (layout.edges[1] - layout.edges[0]) / map.grid().pitch_z.si();
  const double shared = std::max(1.0, std::min(map.noise_length_x(), columns)) *
                        std::max(1.0, std::min(map.noise_length_z(), rows));
  const Array2 sag = curvature_along(cut) * cells.sag;
  const Array2 variance = noise.si() * noise.si() * shared * cells.gain + sag.square();
  cut.sigma = good.select(variance.sqrt() / cells.found.max(1e-300), 0.0);
  return cut;
}

}  // namespace manoscope::maps
