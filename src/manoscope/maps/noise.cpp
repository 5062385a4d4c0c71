#include "manoscope/maps/noise.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "manoscope/numerics/grid_plane.hpp"

namespace manoscope::maps {
namespace {

using numerics::GridPoints;
using Run = GridPoints::Run;

/// Heights of the rim in the layout of its GridPoints; 0 where they do not count.
struct QuietRim {
  std::vector<double> height;
  std::vector<FlagBits> counts;
};

QuietRim quiet_rim(const GridPoints& points, double largest) {
  const std::vector<double>& values = points.values();
  QuietRim rim{std::vector<double>(values.size()), std::vector<FlagBits>(values.size())};
  for (std::size_t i = 0; i < values.size(); ++i) {
    const bool counts = std::abs(values[i]) <= largest;
    rim.counts[i] = counts ? 1 : 0;
    rim.height[i] = counts ? values[i] : 0.0;
  }
  return rim;
}

/// Sum of products of heights, and how many of them.
struct Products {
  double sum = 0.0;
  Index pairs = 0;

  void add(const QuietRim& rim, Index here, Index there, Index n) {
    using List = Eigen::Map<const Array1>;
    sum += (List(rim.height.data() + here, n) * List(rim.height.data() + there, n)).sum();
    unsigned found = 0;  // narrower than Index: more of them side by side
    for (Index i = 0; i < n; ++i) {
      found += rim.counts[static_cast<std::size_t>(here + i)] &
               rim.counts[static_cast<std::size_t>(there + i)];
    }
    pairs += found;
  }
};

/// Products of the heights of every run with those `lag` columns further on in its row.
Products along_rows(const GridPoints& points, const QuietRim& rim, Index lag) {
  Products products;
  const std::vector<Run>& runs = points.runs();
  for (std::size_t k = 0; k < runs.size(); ++k) {
    const Index end = runs[k].first + runs[k].length;
    for (std::size_t m = k; m < runs.size() && runs[m].row == runs[k].row; ++m) {
      const Index first = std::max(runs[k].first, runs[m].first - lag);
      const Index n = std::min(end, runs[m].first + runs[m].length - lag) - first;
      if (n <= 0) continue;
      products.add(rim, runs[k].start + first - runs[k].first,
                   runs[m].start + first + lag - runs[m].first, n);
    }
  }
  return products;
}

/// Products of the heights of every run with those `lag` rows further on.
Products across_rows(const GridPoints& points, const QuietRim& rim, Index lag) {
  Products products;
  const std::vector<Run>& runs = points.runs();
  std::size_t next = 0;  // the first run of the other row
  for (const Run& run : runs) {
    while (next < runs.size() && runs[next].row < run.row + lag) ++next;
    for (std::size_t m = next; m < runs.size() && runs[m].row == run.row + lag; ++m) {
      const Index first = std::max(run.first, runs[m].first);
      const Index n = std::min(run.first + run.length, runs[m].first + runs[m].length) - first;
      if (n <= 0) continue;
      products.add(rim, run.start + first - run.first, runs[m].start + first - runs[m].first, n);
    }
  }
  return products;
}

/// 1 + 2 sum rho_k over the lags at which rho_k stands above twice its own noise.
double correlation_length(double variance, const std::function<Products(Index)>& at_lag) {
  constexpr Index kMostLags = 50;
  double length = 1.0;
  for (Index lag = 1; lag <= kMostLags; ++lag) {
    const Products products = at_lag(lag);
    if (products.pairs == 0) break;
    const auto pairs = static_cast<double>(products.pairs);
    const double rho = products.sum / pairs / variance;
    if (rho < 2.0 / std::sqrt(pairs)) break;
    length += 2.0 * rho;
  }
  return length;
}

}  // namespace

PixelNoise measure_noise(const ChannelMap& leveled, const Flags2& rim) {
  constexpr double kOutlier = 5.0;
  const GridPoints points(Array1::Zero(rim.cols()), Array1::Zero(rim.rows()), leveled.height, rim,
                          leveled.flags);
  PixelNoise noise;
  if (points.size() == 0) return noise;
  const double sigma = numerics::mad_sigma(points);
  noise.sigma = Length::from_si(sigma);
  const QuietRim quiet = quiet_rim(points, kOutlier * sigma);
  const Products squares = along_rows(points, quiet, 0);
  if (squares.pairs == 0 || squares.sum <= 0.0) return noise;
  const double variance = squares.sum / static_cast<double>(squares.pairs);
  noise.length_x =
      correlation_length(variance, [&](Index lag) { return along_rows(points, quiet, lag); });
  noise.length_z =
      correlation_length(variance, [&](Index lag) { return across_rows(points, quiet, lag); });
  return noise;
}

}  // namespace manoscope::maps
