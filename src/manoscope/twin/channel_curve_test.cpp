#include "manoscope/twin/channel_curve.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace manoscope::twin {
namespace {

TEST(ChannelCurve, ReproducesACubicEverywhereAndIsZeroOutside) {
  const auto cubic = [](double x) { return 1.0 + x * (2.0 - x * (3.0 - 0.5 * x)); };
  const ChannelCurve curve(Length::from_si(2.0), Array1::LinSpaced(9, 0.0, 2.0).unaryExpr(cubic));
  for (const double x : {0.0, 0.01, 0.5, 0.77, 1.9, 2.0}) {
    EXPECT_NEAR(curve(x), cubic(x), 1e-14) << x;
  }
  EXPECT_EQ(curve(-1e-9), 0.0);
  EXPECT_EQ(curve(2.0 + 1e-9), 0.0);
}

TEST(ChannelCurve, IsOfFourthOrderForASmoothFunction) {
  double before = 0.0;
  for (const Index n : {41, 81, 161}) {
    const ChannelCurve curve(Length::from_si(3.0), Array1::LinSpaced(n, 0.0, 3.0).sin());
    const Array1 x = Array1::LinSpaced(997, 0.0, 3.0);
    const double error = (curve(x) - x.sin()).abs().maxCoeff();
    if (before > 0.0) {
      EXPECT_NEAR(std::log2(before / error), 4.0, 0.2);
    }
    before = error;
  }
}

TEST(ChannelCurve, GradedPassesThroughItsNodesAndIsOfFourthOrderToo) {
  const Length length = Length::from_si(3.0);
  double before = 0.0;
  for (const Index n : {60, 120, 240}) {
    const Array1 nodes = ChannelCurve::nodes(length, n, 0.9);
    EXPECT_NEAR((nodes(1) - nodes(0)) / (3.0 / static_cast<double>(n)), 0.1, 0.01);
    EXPECT_EQ(nodes(n), 3.0);
    const auto layer = [](double x) { return std::exp(-x / 0.2); };  // at the end, as walls have
    const ChannelCurve curve(length, nodes.unaryExpr(layer), 0.9);
    // 1e-9: a node's own s is found to 1e-15, but x hardly moves with s at the ends.
    EXPECT_LT((curve(nodes) - nodes.unaryExpr(layer)).abs().maxCoeff(), 1e-9);
    EXPECT_TRUE((curve.x() == nodes).all());
    const Array1 x = Array1::LinSpaced(997, 0.0, 3.0);
    const double error = (curve(x) - x.unaryExpr(layer)).abs().maxCoeff();
    if (before > 0.0) {
      EXPECT_NEAR(std::log2(before / error), 4.0, 0.3);
    }
    before = error;
  }
}

TEST(ChannelCurve, StretchIsTheDerivativeOfTheNodes) {
  const Length length = Length::from_si(3.0);
  const Array1 nodes = ChannelCurve::nodes(length, 1000, 0.9);
  const Array1 stretch = ChannelCurve::stretch(length, 1000, 0.9);
  for (const Index i : {1, 250, 500, 999}) {
    // Central difference: (2 pi/1000)^2/6 of the mean spacing.
    EXPECT_NEAR((nodes(i + 1) - nodes(i - 1)) * 500.0, stretch(i), 3e-5);
  }
}

}  // namespace
}  // namespace manoscope::twin
