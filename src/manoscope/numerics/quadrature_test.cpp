#include "manoscope/numerics/quadrature.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace manoscope::numerics {
namespace {

TEST(TrapezoidWeights, IntegrateLinesExactlyAndConvergeAtSecondOrder) {
  const auto error = [](Index n) {
    Array1 x = Array1::LinSpaced(n, 0.0, 1.0).square();  // uneven on purpose
    return std::abs((trapezoid_weights(x) * x.exp()).sum() - (std::exp(1.0) - 1.0));
  };
  Array1 x(4);
  x << 0.0, 0.1, 0.7, 1.0;
  EXPECT_NEAR((trapezoid_weights(x) * (2.0 * x + 1.0)).sum(), 2.0, 1e-15);
  EXPECT_NEAR(std::log2(error(51) / error(101)), 2.0, 0.1);
}

}  // namespace
}  // namespace manoscope::numerics
