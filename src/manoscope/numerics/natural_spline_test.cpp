#include "manoscope/numerics/natural_spline.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace manoscope::numerics {
namespace {

Array1 uneven_nodes(Index n) {
  Array1 nodes(n);
  for (Index i = 0; i < n; ++i) {
    const double s = static_cast<double>(i) / static_cast<double>(n - 1);
    nodes[i] = 3.0 * (s + 0.3 * s * (1.0 - s));
  }
  return nodes;
}

TEST(NaturalSpline, PassesThroughItsNodesAndContinuesStraight) {
  const NaturalSpline spline(uneven_nodes(9));
  const Array1 y = spline.nodes().sin();
  const Array1 at_nodes = (spline.sampling(spline.nodes()) * y.matrix()).array();
  EXPECT_LT((at_nodes - y).abs().maxCoeff(), 1e-14);
  Array1 beyond(3);
  beyond << -1.0, -0.5, 0.0;
  const Array1 left = (spline.sampling(beyond) * y.matrix()).array();
  EXPECT_NEAR(left[0] - 2.0 * left[1] + left[2], 0.0, 1e-14);
  // No kink at the first node: the slope from outside is that from inside.
  Array1 near(3);
  near << -1e-5, 0.0, 1e-5;
  const Array1 around = (spline.sampling(near) * y.matrix()).array();
  EXPECT_NEAR(around[2] - around[1], around[1] - around[0], 1e-13);
}

TEST(NaturalSpline, ConvergesWithTheFourthPowerInside) {
  // sin on [0, pi] has no curvature at the ends: natural splines are of full order there.
  double before = 0.0;
  for (const Index n : {11, 21, 41}) {
    const NaturalSpline spline(Array1::LinSpaced(n, 0.0, std::acos(-1.0)));
    const Array1 at = Array1::LinSpaced(301, 0.0, std::acos(-1.0));
    const Array1 error = (spline.sampling(at) * spline.nodes().sin().matrix()).array() - at.sin();
    const double largest = error.abs().maxCoeff();
    if (before > 0.0) {
      EXPECT_NEAR(std::log2(before / largest), 4.0, 0.2);
    }
    before = largest;
  }
}

TEST(NaturalSpline, RoughnessIsTheIntegralOfTheSquaredSecondDerivative) {
  const NaturalSpline spline(uneven_nodes(12));
  const Index n = spline.nodes().size();
  Eigen::VectorXd coefficients(n);
  for (Index i = 0; i < n; ++i) coefficients[i] = std::cos(2.0 * static_cast<double>(i));
  const double rough = coefficients.dot(spline.roughness(Array1::Ones(n - 2)) * coefficients);
  // Second differences of the sampled spline, Simpson's rule within each interval: exact for the
  // square of a linear function.
  const Eigen::VectorXd values = spline.from_coefficients() * coefficients;
  double expected = 0.0;
  const double h = 1e-3;
  const auto second = [&](double x) {
    Array1 at(3);
    at << x - h, x, x + h;
    const Eigen::VectorXd y = spline.sampling(at) * values;
    return (y[0] - 2.0 * y[1] + y[2]) / (h * h);
  };
  for (Index j = 1; j < n; ++j) {
    const double a = spline.nodes()[j - 1] + h, b = spline.nodes()[j] - h, m = 0.5 * (a + b);
    const double whole = (b - a + 2.0 * h) / (b - a);
    // Trimmed by h at both ends, where the difference would straddle a node; linear in between.
    const double ya = second(a), yb = second(b), ym = second(m);
    const double end_a = ym + (ya - ym) * whole, end_b = ym + (yb - ym) * whole;
    expected += (b - a + 2.0 * h) / 6.0 * (end_a * end_a + 4.0 * ym * ym + end_b * end_b);
  }
  EXPECT_NEAR(rough / expected, 1.0, 1e-6);  // round-off of second differences: 1e-15/h^2
}

TEST(NaturalSpline, LinesAreNotRough) {
  const NaturalSpline spline(uneven_nodes(7));
  Eigen::VectorXd coefficients = Eigen::VectorXd::Zero(7);
  coefficients[0] = 2.0;
  coefficients[1] = -3.0;
  EXPECT_EQ(coefficients.dot(spline.roughness(Array1::Ones(5)) * coefficients), 0.0);
  const Eigen::VectorXd y = spline.from_coefficients() * coefficients;
  EXPECT_DOUBLE_EQ(y[0], 5.0);
  EXPECT_DOUBLE_EQ(y[6], -1.0);
}

}  // namespace
}  // namespace manoscope::numerics
