#include "manoscope/flow/spectral.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace manoscope::flow {
namespace {

TEST(GaussLegendre, IntegratesPolynomialsOfDegreeTwiceItsPointsLessOne) {
  for (const int n : {1, 2, 5, 20, 61, 160}) {
    const QuadratureRule rule = gauss_legendre(n);
    for (const int power : {0, n - n % 2, 2 * n - 2}) {
      // Round-off of n terms.
      EXPECT_NEAR((rule.weights * rule.nodes.pow(power)).sum(), 2.0 / (power + 1.0), 1e-13) << n;
    }
    EXPECT_NEAR((rule.weights * rule.nodes).sum(), 0.0, 1e-15);
  }
}

TEST(BubbleFunctions, VanishAtTheEndsAndHaveTheirSlopes) {
  Array1 ends(2);
  ends << -1.0, 1.0;
  EXPECT_LT(bubble_functions(ends, 30).values.cwiseAbs().maxCoeff(), 1e-14);
  const double at = 0.37, step = 1e-6;
  Array1 around(3);
  around << at - step, at, at + step;
  const BubbleFunctions bubbles = bubble_functions(around, 12);
  for (Index k = 0; k < bubbles.values.cols(); ++k) {
    const double difference = (bubbles.values(2, k) - bubbles.values(0, k)) / (2.0 * step);
    EXPECT_NEAR(bubbles.slopes(1, k), difference, 1e-8);  // round-off 1e-16/step
  }
}

TEST(ChebyshevBasis, DifferentiatesAndIntegratesItsPolynomialsExactly) {
  const NodalBasis basis = chebyshev_basis(9);
  const Array1& t = basis.nodes;
  const Array1 f = t.pow(9) - 3.0 * t.square() + 1.0;
  const Array1 slope = 9.0 * t.pow(8) - 6.0 * t;
  const Array1 integral = t.pow(10) / 10.0 - t.cube() + t;
  EXPECT_LT(((basis.derivative * f.matrix()).array() - slope).abs().maxCoeff(), 1e-12);
  EXPECT_LT(((basis.integral * f.matrix()).array() - integral).abs().maxCoeff(), 1e-14);
  EXPECT_NEAR((basis.weights * f).sum(), 0.1, 1e-14);
}

TEST(EvenChebyshevBasis, KnowsEvenAndOddFunctions) {
  const EvenBasis basis = even_chebyshev_basis(8);
  const Array1& s = basis.nodes;
  EXPECT_EQ(s(0), 0.0);
  const Array1 even = s.pow(4) - 2.0 * s.square(), odd = s.pow(5) - s;
  const auto error = [](const Matrix& matrix, const Array1& f, const Array1& truth) {
    return ((matrix * f.matrix()).array() - truth).abs().maxCoeff();
  };
  // Round-off times the square of the number of nodes, and again for the second derivative.
  EXPECT_LT(error(basis.even_slope, even, 4.0 * s.cube() - 4.0 * s), 1e-12);
  EXPECT_LT(error(basis.odd_slope, odd, 5.0 * s.pow(4) - 1.0), 1e-12);
  EXPECT_LT(error(basis.even_bend, even, 12.0 * s.square() - 4.0), 1e-10);
  EXPECT_LT(error(basis.integral, even, s.pow(5) / 5.0 - 2.0 / 3.0 * s.cube()), 1e-14);
  EXPECT_NEAR((basis.weights * even).sum(), 0.2 - 2.0 / 3.0, 1e-14);
  // s^5 - s = (10 T_1 + 5 T_3 + T_5)/16 - T_1.
  const Array1 coefficients = (basis.odd_transform * odd.matrix()).array();
  EXPECT_NEAR(coefficients(0), 10.0 / 16.0 - 1.0, 1e-13);
  EXPECT_NEAR(coefficients(1), 5.0 / 16.0, 1e-13);
  EXPECT_NEAR(coefficients(2), 1.0 / 16.0, 1e-13);
}

}  // namespace
}  // namespace manoscope::flow
