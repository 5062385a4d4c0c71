#include "manoscope/numerics/shape_spline.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "manoscope/core/random.hpp"

namespace manoscope::numerics {
namespace {

ShapeSpline sampled(int n, double (*f)(double)) {
  std::vector<double> u, y;
  for (int j = 0; j < n; ++j) {
    u.push_back(static_cast<double>(j) / (n - 1));
    y.push_back(f(u.back()));
  }
  return {u, y};
}

TEST(ShapeSpline, ConvergesAtThirdOrderForSmoothData) {
  const auto worst = [](int n) {
    const ShapeSpline spline = sampled(n, [](double u) { return std::exp(2.0 * u); });
    double error = 0.0;
    for (double u = 0.2; u < 0.8; u += 0.00137) {
      error = std::max(error, std::abs(spline.value(u) - std::exp(2.0 * u)));
    }
    return error;
  };
  EXPECT_NEAR(std::log2(worst(41) / worst(81)), 3.0, 0.1);
}

TEST(ShapeSpline, KeepsRandomMonotoneDataMonotoneAndInvertsThem) {
  RandomStream stream(5, "monotone");
  for (int trial = 0; trial < 200; ++trial) {
    std::vector<double> u{0.0}, y{0.0};
    for (int j = 0; j < 12; ++j) {
      u.push_back(u.back() + 0.01 + stream.uniform());
      y.push_back(y.back() + std::pow(stream.uniform(), 4) + 1e-6);
    }
    const ShapeSpline spline(u, y);
    double last = spline.value(u.front());
    for (int i = 1; i <= 500; ++i) {
      const double at = std::min(u.back(), u.front() + (u.back() - u.front()) * i / 500.0);
      const double value = spline.value(at);
      EXPECT_GE(value, last - 1e-14 * std::abs(last));  // round-off
      last = value;
      const auto roots = spline.solve(value);
      ASSERT_EQ(roots.size(), 1u);
      EXPECT_NEAR(spline.value(roots[0]), value, 1e-13 * y.back());  // round-off
    }
  }
}

TEST(ShapeSpline, FindsEverySolutionOfAFold) {
  const ShapeSpline spline({0.0, 1.0, 2.0, 3.0}, {0.0, 2.0, 1.0, 3.0});
  EXPECT_EQ(spline.solve(1.5).size(), 3u);
  EXPECT_EQ(spline.solve(0.5).size(), 1u);
  EXPECT_EQ(spline.solve(2.0).size(), 2u);  // at the turning point and on the last branch
  EXPECT_TRUE(spline.solve(3.5).empty());
  EXPECT_TRUE(spline.solve(-0.1).empty());
}

TEST(ShapeSpline, WeightsAreTheDerivativesWithRespectToTheValues) {
  RandomStream stream(6, "weights");
  std::vector<double> u{0.0}, y{0.0};
  for (int j = 0; j < 8; ++j) {
    u.push_back(u.back() + 0.5 + stream.uniform());
    y.push_back(y.back() + 0.1 + stream.uniform());
  }
  const ShapeSpline spline(u, y);
  constexpr double kStep = 1e-6;
  for (double at = 0.01; at < u.back(); at += 0.237) {
    std::vector<double> expected(u.size(), 0.0);
    for (std::size_t j = 0; j < u.size(); ++j) {
      auto up = y, down = y;
      up[j] += kStep;
      down[j] -= kStep;
      expected[j] = (ShapeSpline(u, up).value(at) - ShapeSpline(u, down).value(at)) / (2 * kStep);
    }
    for (const auto& [j, weight] : spline.weights(at)) {
      // Round-off over the step, and its square times a third derivative of order 100.
      EXPECT_NEAR(weight, expected[static_cast<std::size_t>(j)], 1e-8);
      expected[static_cast<std::size_t>(j)] = 0.0;
    }
    for (const double rest : expected) EXPECT_NEAR(rest, 0.0, 1e-8);
  }
}

TEST(ShapeSpline, KnotWeightsAreTheDerivativesWithRespectToTheKnotsAndSumToMinusTheSlope) {
  // Bent sharply in the middle, where the slope of a knot says nothing about its neighbour's
  // interval.
  const std::vector<double> u{0.0, 1.0, 1.8, 3.0, 3.9, 5.0, 6.0};
  const std::vector<double> y{0.0, 0.1, 0.3, 4.0, 7.8, 8.0, 8.1};
  const ShapeSpline spline(u, y);
  constexpr double kStep = 1e-5;
  for (double at = 0.05; at < 6.0; at += 0.173) {
    double sum = 0.0;
    for (const auto& [j, weight] : spline.knot_weights(at)) {
      auto up = u, down = u;
      up[static_cast<std::size_t>(j)] += kStep;
      down[static_cast<std::size_t>(j)] -= kStep;
      const double expected =
          (ShapeSpline(up, y).value(at) - ShapeSpline(down, y).value(at)) / (2.0 * kStep);
      // Differences of another step, over the whole spline: its square times a derivative of order
      // 1e3.
      EXPECT_NEAR(weight, expected, 1e-6) << at << " " << j;
      sum += weight;
    }
    EXPECT_NEAR(sum, -spline.derivative(at), 1e-6) << at;
  }
}

TEST(ShapeSpline, DerivativeAgreesWithDifferences) {
  const ShapeSpline spline = sampled(9, [](double u) { return std::sin(3.0 * u); });
  for (double at = 0.03; at < 0.97; at += 0.05) {
    constexpr double kStep = 1e-5;
    const double difference = (spline.value(at + kStep) - spline.value(at - kStep)) / (2 * kStep);
    EXPECT_NEAR(spline.derivative(at), difference, 1e-7);  // third derivative times step squared
  }
}

TEST(ShapeSpline, DoubtIsOfTheSizeOfTheErrorAndVanishesAtTheKnots) {
  const ShapeSpline spline = sampled(9, [](double u) { return std::exp(4.0 * u); });
  double doubt = 0.0, error = 0.0;
  for (double at = 0.13; at < 0.87; at += 0.003) {
    doubt += std::pow(spline.doubt(at), 2);
    error += std::pow(spline.value(at) - std::exp(4.0 * at), 2);
  }
  // With step h and derivatives y2, y3 the parabola's slope errs by h^2 y3 / 6, the harmonic mean
  // by h^2 y2^2 / (4 y1) less: for an exponential the doubt is 3 times the error, to leading order.
  EXPECT_GT(std::sqrt(doubt / error), 1.0);
  EXPECT_LT(std::sqrt(doubt / error), 4.0);
  EXPECT_EQ(spline.doubt(0.25), 0.0);
  EXPECT_EQ(spline.doubt(0.5), 0.0);
}

TEST(ShapeSpline, TwoKnotsMakeALine) {
  const ShapeSpline spline({1.0, 3.0}, {2.0, 6.0});
  EXPECT_DOUBLE_EQ(spline.value(2.5), 5.0);
  EXPECT_DOUBLE_EQ(spline.solve(3.0).at(0), 1.5);
  double sum = 0.0;
  for (const auto& [j, weight] : spline.weights(1.5)) sum += weight * spline.knot_value(j);
  EXPECT_DOUBLE_EQ(sum, 3.0);  // the interpolant is of degree one in its values
}

}  // namespace
}  // namespace manoscope::numerics
