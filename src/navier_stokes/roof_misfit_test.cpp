#include "roof_misfit.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace manoscope::navier_stokes {
namespace {

TEST(RoofMisfit, IsNoneForPolynomialsOfTheOrderOfTheCells) {
  const std::vector<double> x{0.0, 0.3, 1.0, 1.2}, z{0.0, 0.5, 1.0};
  for (const int order : {2, 3, 4}) {
    const auto gap = [order](double at, double across) {
      return 2.0 + std::pow(at, order) - 0.5 * std::pow(across, order);
    };
    EXPECT_LT(roof_misfit(gap, x, z, order).share, 1e-14) << order;
    EXPECT_LT(roof_misfit(gap, x, {}, order).share, 1e-14) << order;
    const auto steeper = [order](double at, double) { return 2.0 + std::pow(at, order + 1); };
    EXPECT_GT(roof_misfit(steeper, x, z, order).share, 1e-4) << order;
  }
}

TEST(RoofMisfit, FallsWithTheThirdPowerOfQuadraticCells) {
  const auto misfit = [](int n) {
    std::vector<double> edges;
    for (int i = 0; i <= n; ++i) edges.push_back(static_cast<double>(i) / n);
    return roof_misfit([](double x, double) { return 2.0 + std::sin(3.0 * x); }, edges, {}, 2)
        .share;
  };
  EXPECT_NEAR(misfit(10) / misfit(20), 8.0, 0.5);
}

TEST(RoofMisfit, NamesTheWorstPlace) {
  const auto gap = [](double x, double z) {
    return 1.0 + 0.5 * std::exp(-std::pow((x - 2.5) / 0.1, 2) - std::pow((z - 0.7) / 0.1, 2));
  };
  const RoofMisfit found =
      roof_misfit(gap, {0.0, 1.0, 2.0, 3.0, 4.0}, {0.0, 0.25, 0.5, 0.75, 1.0}, 2);
  EXPECT_GT(found.share, 0.05);
  EXPECT_GT(found.x, 2.0);
  EXPECT_LT(found.x, 3.0);
  EXPECT_GT(found.z, 0.5);
  EXPECT_LT(found.z, 1.0);
}

}  // namespace
}  // namespace manoscope::navier_stokes
