#include "passage_mesh.hpp"

#include <algorithm>
#include <cmath>

#include "mesh_pair.hpp"

namespace manoscope::navier_stokes {
namespace {

/// What is asked for.
struct Sizes {
  const std::vector<FineSpot>& spots;
  double growth, largest;

  double at(double x) const {
    double size = largest;
    for (const FineSpot& spot : spots) {
      size = std::min(size, spot.size + growth * std::abs(x - spot.place));
    }
    return size;
  }
};

/// Inner ends of the cells between two breaks, and the upper break.
void fill(double low, double high, const Sizes& sizes, bool coarse, std::vector<double>& edges) {
  constexpr int kSteps = 2000;  // of the midpoint rule: the sizes need not be exact
  std::vector<double> share(1, 0.0);
  const double step = (high - low) / kSteps;
  for (int i = 0; i < kSteps; ++i) {
    share.push_back(share.back() + step / sizes.at(low + (i + 0.5) * step));
  }
  int n = std::max(kFewestCells, static_cast<int>(std::ceil(share.back())));
  // Of 4, 7, 10, ... cells two thirds are rounded up.
  if (n % 3 == 1) ++n;
  if (coarse) n = coarser_cells(n);
  int at = 0;
  for (int cell = 1; cell < n; ++cell) {
    const double wanted = share.back() * cell / n;
    while (share[at + 1] < wanted) ++at;
    edges.push_back(low + step * (at + (wanted - share[at]) / (share[at + 1] - share[at])));
  }
  edges.push_back(high);
}

}  // namespace

std::vector<double> graded_edges(std::vector<double> breaks, const std::vector<FineSpot>& spots,
                                 double growth, double largest, bool coarse) {
  constexpr double kSame = 1e-9;  // of the whole: two ways to compute one place
  std::sort(breaks.begin(), breaks.end());
  const double whole = breaks.back() - breaks.front();
  breaks.erase(std::unique(breaks.begin(), breaks.end(),
                           [&](double a, double b) { return b - a < kSame * whole; }),
               breaks.end());
  std::vector<double> edges(1, breaks.front());
  for (std::size_t i = 1; i < breaks.size(); ++i) {
    fill(breaks[i - 1], breaks[i], {spots, growth, largest}, coarse, edges);
  }
  return edges;
}

}  // namespace manoscope::navier_stokes
