#include "manoscope/wall/hermite_grid.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "manoscope/wall/line_load.hpp"

namespace manoscope::wall {
namespace {

// Any cubic is its own interpolant; tolerances are round-off of a few operations.
double cubic(double x) { return 2.0 - x + 3.0 * x * x - 0.5 * x * x * x; }
double cubic_slope(double x) { return -1.0 + 6.0 * x - 1.5 * x * x; }
double cubic_curvature(double x) { return 6.0 - 3.0 * x; }

TEST(Hermite, ReproducesCubicsWithTheirDerivativesAndIntegral) {
  const double from = 0.3, h = 0.7;
  const HermiteValues nodal = {cubic(from), cubic_slope(from), cubic(from + h),
                               cubic_slope(from + h)};
  const auto sum = [&](const HermiteValues& functions) {
    double total = 0.0;
    for (int f = 0; f < 4; ++f) total += nodal[f] * functions[f];
    return total;
  };
  for (const double s : {0.0, 0.2, 0.65, 1.0}) {
    const double x = from + s * h;
    EXPECT_NEAR(sum(hermite(s, h, 0)), cubic(x), 1e-14);
    EXPECT_NEAR(sum(hermite(s, h, 1)), cubic_slope(x), 1e-13);
    EXPECT_NEAR(sum(hermite(s, h, 2)), cubic_curvature(x), 1e-12);
  }
  const auto primitive = [](double x) {
    return 2.0 * x - x * x / 2.0 + x * x * x - x * x * x * x / 8.0;
  };
  EXPECT_NEAR(sum(hermite_integral(h)), primitive(from + h) - primitive(from), 1e-14);
}

TEST(GradedNodes, AreDenseAtTheRefinedEndsAndNestWhenDoubled) {
  const Array1 nodes = graded_nodes(0.0, 4.0, RefinedEnds::both, 0.01, 1.0, 20);
  EXPECT_EQ(nodes(0), 0.0);
  EXPECT_EQ(nodes(20), 4.0);
  EXPECT_LT(nodes(1), 0.02);  // evenly spaced: 0.2
  for (Index i = 0; i < 20; ++i) EXPECT_LT(nodes(i), nodes(i + 1));
  for (Index i = 0; i <= 20; ++i) EXPECT_NEAR(nodes(i) + nodes(20 - i), 4.0, 1e-15 * 16);
  const Array1 finer = graded_nodes(0.0, 4.0, RefinedEnds::both, 0.01, 1.0, 40);
  for (Index i = 0; i <= 20; ++i) EXPECT_NEAR(finer(2 * i), nodes(i), 1e-14);
  const Array1 one_end = graded_nodes(0.0, 2.0, RefinedEnds::last, 0.01, 1.0, 10);
  EXPECT_GT(one_end(1) - one_end(0), 10.0 * (one_end(10) - one_end(9)));
}

TEST(StationWeights, IntegrateAPiecewiseLinearPressureExactly) {
  const HermiteAxis axis(graded_nodes(0.0, 3.0, RefinedEnds::both, 0.2, 1.0, 6));
  Array1 stations(4), pressure(4);
  stations << 0.4, 1.1, 1.15, 2.6;
  pressure << 3.0, -1.0, 2.0, 5.0;
  const Eigen::VectorXd load = station_weights(axis, stations) * pressure.matrix();
  // Work on the deflections 1 and x, which the functions hold exactly: areas of trapezia.
  double area = 0.0, moment = 0.0;
  const auto piece = [&](double x0, double x1, double p0, double p1) {
    area += 0.5 * (p0 + p1) * (x1 - x0);
    moment += (x1 - x0) * ((2.0 * p0 + p1) * x0 + (p0 + 2.0 * p1) * x1) / 6.0;
  };
  piece(0.0, 0.4, 3.0, 3.0);
  piece(0.4, 1.1, 3.0, -1.0);
  piece(1.1, 1.15, -1.0, 2.0);
  piece(1.15, 2.6, 2.0, 5.0);
  piece(2.6, 3.0, 5.0, 5.0);
  double on_one = 0.0, on_x = 0.0;
  for (Index i = 0; i < axis.n_nodes(); ++i) {
    on_one += load(2 * i);
    on_x += load(2 * i) * axis.node(i) + load(2 * i + 1);
  }
  EXPECT_NEAR(on_one, area, 1e-13);
  EXPECT_NEAR(on_x, moment, 1e-13);
}

}  // namespace
}  // namespace manoscope::wall
