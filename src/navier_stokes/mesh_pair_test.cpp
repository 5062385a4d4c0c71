#include "mesh_pair.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "passage_mesh.hpp"

namespace manoscope::navier_stokes {
namespace {

TEST(MeshPair, TheCoarserMeshHasFewerCellsOfAnyNumber) {
  for (int n = kFewestCells; n <= 1000; ++n) {
    EXPECT_GE(coarser_cells(n), 2);
    EXPECT_LE(3 * coarser_cells(n), 2 * n + 1);
    EXPECT_GE(3 * coarser_cells(n), 2 * n - 1);
  }
}

TEST(MeshPair, CoversAnErrorOfFirstOrderAlongAnyAxis) {
  for (int up = kFewestCells; up <= 12; ++up) {
    for (int across = kFewestCells; across <= 12; ++across) {
      const double factor = uncertainty_of_difference(
          {{120, coarser_cells(120)}, {up, coarser_cells(up)}, {across, coarser_cells(across)}});
      for (const double share : {0.0, 0.3, 1.0}) {  // of the error that is one axis's
        const auto error = [share](int n, int m) { return share / n + (1.0 - share) / m; };
        const double fine = error(up, across);
        const double coarse = error(coarser_cells(up), coarser_cells(across));
        EXPECT_GE(factor * (coarse - fine), fine * (1.0 - 1e-12)) << up << ' ' << across;
      }
    }
  }
}

TEST(GradedEdges, HaveAtMostTwoThirdsOfTheCellsOfAnyStretchOnTheCoarserMesh) {
  for (const double size : {10.0, 0.9, 0.45, 0.26, 0.21, 0.15, 0.13, 0.02}) {
    const auto cells = [size](bool coarse) {
      const std::vector<double> breaks{0.0, 1.0, 1.1};
      const auto edges = graded_edges(breaks, {{0.0, size}}, 0.5, size, coarse);
      const auto first =
          std::count_if(edges.begin(), edges.end(), [](double x) { return x < 1.0 - 1e-9; });
      return std::pair{static_cast<int>(first),
                       static_cast<int>(edges.size()) - 1 - static_cast<int>(first)};
    };
    const auto [first, second] = cells(false);
    const auto [coarse_first, coarse_second] = cells(true);
    EXPECT_GE(first, std::ceil(1.0 / size));
    EXPECT_GE(2 * first, 3 * coarse_first) << size;
    EXPECT_GE(2 * second, 3 * coarse_second) << size;
    EXPECT_GE(std::min(coarse_first, coarse_second), 2) << size;
  }
}

}  // namespace
}  // namespace manoscope::navier_stokes
