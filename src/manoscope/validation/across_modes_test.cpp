#include "manoscope/validation/across_modes.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "manoscope/numerics/quadrature.hpp"

namespace manoscope::validation {
namespace {

class Modes : public testing::TestWithParam<std::vector<double>> {};

TEST_P(Modes, AreClampedOrthonormalAndLeaveTheMean) {
  const flow::WallShape shape(GetParam());
  const AcrossModes modes(shape, 5, 4);
  EXPECT_GE(modes.n_even(), 5);
  EXPECT_EQ(modes.n_odd(), 4);
  const Array1 s = Array1::LinSpaced(4001, -1.0, 1.0);
  const Matrix values = modes.at(s);
  const Array1 weight = 0.5 * numerics::trapezoid_weights(s);
  constexpr double kTrapezoid = 1e-4;  // of degree 24 on steps of 1/2000
  const Matrix products = values.transpose() * weight.matrix().asDiagonal() * values;
  for (Index k = 1; k <= modes.size(); ++k) {
    EXPECT_NEAR(values(0, k), 0.0, 1e-9) << k;
    EXPECT_NEAR(values(4000, k), 0.0, 1e-9) << k;
    EXPECT_NEAR((weight * values.col(k).array()).sum(), 0.0, kTrapezoid) << k;
    for (Index i = 1; i <= modes.size(); ++i) {
      EXPECT_NEAR(products(i, k), i == k ? 1.0 : 0.0, kTrapezoid) << i << ", " << k;
    }
    const double sign = k <= modes.n_even() ? 1.0 : -1.0;
    const Matrix mirrored = modes.at(-s);
    EXPECT_LT((mirrored.col(k) - sign * values.col(k)).cwiseAbs().maxCoeff(), 1e-9) << k;
  }
  for (Index i = 0; i < s.size(); i += 400) EXPECT_NEAR(values(i, 0), shape.value(s[i]), 1e-12);
}

TEST_P(Modes, SlopesAndMeansAreThoseOfTheValues) {
  const AcrossModes modes(flow::WallShape(GetParam()), 4, 3);
  const Array1 edges{{-0.96, -0.3, 0.1, 0.84}};
  const Matrix means = modes.means(edges), slopes = modes.slopes(edges);
  for (Index j = 0; j + 1 < edges.size(); ++j) {
    const Array1 s = Array1::LinSpaced(4001, edges[j], edges[j + 1]);
    const Array1 weight = numerics::trapezoid_weights(s) / (edges[j + 1] - edges[j]);
    const Matrix exact = weight.matrix().transpose() * modes.at(s);
    EXPECT_LT((means.row(j) - exact).cwiseAbs().maxCoeff(), 1e-4);  // trapezoid rule
  }
  constexpr double kStep = 1e-5;  // central difference: error of its square, times 14^3
  const Matrix difference = (modes.at(edges + kStep) - modes.at(edges - kStep)) / (2.0 * kStep);
  EXPECT_LT((slopes - difference).cwiseAbs().maxCoeff(), 1e-5);
}

INSTANTIATE_TEST_SUITE_P(OfShapes, Modes,
                         testing::Values(std::vector<double>{1.0, -1.0},
                                         std::vector<double>{1.0, -2.0, 1.0},
                                         // Its crest is 0: no polynomial less than the whole set.
                                         std::vector<double>{0.0, 1.0, -1.0},
                                         // Of higher degree than the departures.
                                         std::vector<double>{1.0, 0, 0, 0, 0, 0, 0, -1.0}));

TEST(AcrossModes, OfAShapeThatIsNoneOfThePolynomialsAreOneMore) {
  EXPECT_EQ(AcrossModes(flow::WallShape::parabola(), 5, 4).n_even(), 5);
  EXPECT_EQ(AcrossModes(flow::WallShape({1.0, 0, 0, 0, 0, 0, 0, 0, -1.0}), 5, 4).n_even(), 6);
}

}  // namespace
}  // namespace manoscope::validation
