#include "manoscope/twin/uniform_curve.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace manoscope::twin {
namespace {

TEST(UniformCurve, ReproducesACubicEverywhereAndIsZeroOutside) {
  const auto cubic = [](double x) { return 1.0 + x * (2.0 - x * (3.0 - 0.5 * x)); };
  const UniformCurve curve(Length::from_si(2.0), Array1::LinSpaced(9, 0.0, 2.0).unaryExpr(cubic));
  for (const double x : {0.0, 0.01, 0.5, 0.77, 1.9, 2.0}) {
    EXPECT_NEAR(curve(x), cubic(x), 1e-14) << x;
  }
  EXPECT_EQ(curve(-1e-9), 0.0);
  EXPECT_EQ(curve(2.0 + 1e-9), 0.0);
}

TEST(UniformCurve, IsOfFourthOrderForASmoothFunction) {
  double before = 0.0;
  for (const Index n : {41, 81, 161}) {
    const UniformCurve curve(Length::from_si(3.0), Array1::LinSpaced(n, 0.0, 3.0).sin());
    const Array1 x = Array1::LinSpaced(997, 0.0, 3.0);
    const double error = (curve(x) - x.sin()).abs().maxCoeff();
    if (before > 0.0) {
      EXPECT_NEAR(std::log2(before / error), 4.0, 0.2);
    }
    before = error;
  }
}

}  // namespace
}  // namespace manoscope::twin
