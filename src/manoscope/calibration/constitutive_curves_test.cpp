#include "manoscope/calibration/constitutive_curves.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/local_wall.hpp"

namespace manoscope::calibration {
namespace {

using Knot = ConstitutiveCurve::Knot;

const PressureScale kScale(900.0);

std::vector<Knot> knots_of(double (*zeta)(double), const std::vector<double>& pressures) {
  std::vector<Knot> knots;
  for (std::size_t k = 0; k < pressures.size(); ++k) {
    knots.push_back({{static_cast<Index>(k)}, pressures[k], zeta(pressures[k])});
  }
  return knots;
}

double stretching(double p) { return 1e-6 * std::log1p(p / 700.0); }

TEST(ConstitutiveCurve, PassesThroughItsKnotsAndIsInvertedThere) {
  const ConstitutiveCurve curve(kScale, knots_of(stretching, test::log_spaced(15, 100.0, 40e3)));
  for (const Knot& knot : curve.knots()) {
    EXPECT_NEAR(curve.zeta(knot.pressure), knot.zeta, 1e-15 * 4e-6);  // round-off of the largest
    const auto solutions = curve.pressures(knot.zeta);
    ASSERT_EQ(solutions.size(), 1U) << knot.pressure;
    EXPECT_NEAR(solutions[0], knot.pressure, 1e-10 * 40e3);  // round-off over the least slope
  }
  EXPECT_EQ(curve.lowest(), 0.0);
  EXPECT_DOUBLE_EQ(curve.highest(), 40e3);
}

TEST(ConstitutiveCurve, DoesNotExistBeyondItsLevels) {
  const ConstitutiveCurve curve(kScale, knots_of(stretching, test::even(9, 500.0, 40e3)));
  EXPECT_TRUE(curve.pressures(stretching(499.0)).empty());
  EXPECT_TRUE(curve.pressures(stretching(40.1e3)).empty());
  EXPECT_EQ(curve.pressures(stretching(501.0)).size(), 1U);
}

TEST(ConstitutiveCurve, SlopeAgreesWithDifferences) {
  const ConstitutiveCurve curve(kScale, knots_of(stretching, test::log_spaced(15, 100.0, 40e3)));
  for (double p = 37.0; p < 39e3; p *= 1.37) {
    const double step = 1e-4 * p;
    const double difference = (curve.zeta(p + step) - curve.zeta(p - step)) / (2.0 * step);
    // A difference may straddle a knot, where the second derivative jumps: first order in the step.
    EXPECT_NEAR(curve.slope(p) / difference, 1.0, 1e-3) << p;
  }
}

TEST(ConstitutiveCurve, LevelWeightsAreTheDerivativesWithRespectToDeflections) {
  const auto knots = knots_of(stretching, test::log_spaced(10, 200.0, 40e3));
  const ConstitutiveCurve curve(kScale, knots);
  constexpr double kStep = 1e-12;  // m; deflections are 4e-6 at most
  for (double p = 61.0; p < 40e3; p *= 1.61) {
    std::vector<double> weight(knots.size(), 0.0);
    for (const auto& each : curve.level_weights(p)) {
      weight[static_cast<std::size_t>(each.level)] += each.deflection;
    }
    for (std::size_t k = 0; k < knots.size(); ++k) {
      auto up = knots, down = knots;
      up[k].zeta += kStep;
      down[k].zeta -= kStep;
      const double difference =
          (ConstitutiveCurve(kScale, up).zeta(p) - ConstitutiveCurve(kScale, down).zeta(p)) /
          (2.0 * kStep);
      // Round-off 1e-16 x 4e-6 over the step.
      EXPECT_NEAR(weight[k], difference, 1e-8) << "level " << k << " at " << p << " Pa";
    }
  }
}

TEST(ConstitutiveCurve, LevelWeightsSplitAPooledKnotEquallyAmongItsLevels) {
  std::vector<Knot> knots{{{0}, 0.0, 0.0}, {{1, 2, 3}, 1e3, 1e-6}, {{4}, 5e3, 2e-6}};
  const ConstitutiveCurve curve(kScale, knots);
  for (const auto& weight : curve.level_weights(1e3)) {
    const bool pooled = weight.level >= 1 && weight.level <= 3;
    EXPECT_NEAR(weight.deflection, pooled ? 1.0 / 3.0 : 0.0, 1e-14);  // at the knot itself
  }
}

/// Largest relative error of the label weights against refits with one label moved, over the
/// station's pressures and all levels; relative to the slope of the curve.
double worst_label_error(int n) {
  const auto knots = knots_of(stretching, test::even(n, 1e3, 21e3));
  const ConstitutiveCurve curve(kScale, knots);
  double worst = 0.0;
  for (double p = 4e3; p < 16e3; p += 171.0) {
    std::vector<double> weight(knots.size(), 0.0);
    for (const auto& each : curve.level_weights(p)) {
      weight[static_cast<std::size_t>(each.level)] += each.label;
    }
    for (std::size_t k = 0; k < knots.size(); ++k) {
      auto up = knots, down = knots;
      constexpr double kStep = 0.01;  // Pa
      up[k].pressure += kStep;
      down[k].pressure -= kStep;
      const double difference =
          (ConstitutiveCurve(kScale, up).zeta(p) - ConstitutiveCurve(kScale, down).zeta(p)) /
          (2.0 * kStep);
      worst = std::max(worst, std::abs(weight[k] - difference) / curve.slope(p));
    }
  }
  return worst;
}

TEST(ConstitutiveCurve, LabelWeightsAreTheDerivatives) {
  // Two differences of other steps: the square of the larger times a third derivative remains.
  EXPECT_LT(worst_label_error(11), 1e-5);
  EXPECT_LT(worst_label_error(41), 1e-5);
}

TEST(ConstitutiveCurve, LabelWeightsAreExactOnAStraightCurve) {
  std::vector<Knot> knots;
  for (Index k = 0; k < 7; ++k) {
    const double u = 0.3 * static_cast<double>(k * (k + 4));
    knots.push_back({{k}, kScale.pressure(u), 2e-7 * u});
  }
  const ConstitutiveCurve curve(kScale, knots);
  for (const double p : {150.0, 2e3, 9e3, 4e5}) {
    double sum = 0.0;
    for (const auto& weight : curve.level_weights(p)) sum += weight.deflection;
    EXPECT_NEAR(sum, 1.0, 1e-13);  // raising all levels raises the curve as much; round-off
    for (const auto& weight : curve.level_weights(p)) {
      auto up = knots, down = knots;
      constexpr double kStep = 1e-3;  // Pa
      up[static_cast<std::size_t>(weight.level)].pressure += kStep;
      down[static_cast<std::size_t>(weight.level)].pressure -= kStep;
      const double difference =
          (ConstitutiveCurve(kScale, up).zeta(p) - ConstitutiveCurve(kScale, down).zeta(p)) /
          (2.0 * kStep);
      EXPECT_NEAR(weight.label, difference, 1e-6 * curve.slope(p)) << p;  // round-off over step
    }
  }
}

TEST(ConstitutiveCurve, InterpolationDoubtIsZeroAtKnotsAndOnAStraightCurve) {
  const ConstitutiveCurve curve(kScale, knots_of(stretching, test::log_spaced(9, 200.0, 40e3)));
  double largest = 0.0;
  for (const Knot& knot : curve.knots()) {
    EXPECT_NEAR(curve.interpolation_doubt(knot.pressure), 0.0, 1e-20);  // round-off
  }
  for (double p = 50.0; p < 40e3; p *= 1.1) {
    largest = std::max(largest, std::abs(curve.interpolation_doubt(p)));
  }
  EXPECT_GT(largest, 1e-10);
  std::vector<Knot> straight;
  for (Index k = 0; k < 5; ++k) {
    const double u = 0.4 * static_cast<double>(k * k);
    straight.push_back({{k}, kScale.pressure(u), 1e-6 * u});
  }
  const ConstitutiveCurve line(kScale, straight);
  for (double p = 1.0; p < line.highest(); p *= 1.7) {
    EXPECT_NEAR(line.interpolation_doubt(p), 0.0, 1e-19);  // round-off
  }
}

TEST(ConstitutiveCurve, IntervalLevelIsTheKnotBelow) {
  const ConstitutiveCurve curve(
      kScale, {{{0}, 0.0, 0.0}, {{1, 2}, 1e3, 1e-6}, {{3}, 5e3, 2e-6}, {{4}, 9e3, 3e-6}});
  EXPECT_EQ(curve.interval_level(0.0), 0);
  EXPECT_EQ(curve.interval_level(999.0), 0);
  EXPECT_EQ(curve.interval_level(1001.0), 1);
  EXPECT_EQ(curve.interval_level(6e3), 3);
  EXPECT_EQ(curve.interval_level(9e3), 3);
}

}  // namespace
}  // namespace manoscope::calibration
