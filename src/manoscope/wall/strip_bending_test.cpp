#include "manoscope/wall/strip_bending.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace manoscope::wall {
namespace {

constexpr double kPi2 = std::numbers::pi * std::numbers::pi;

// Partial fractions, summed directly with an Euler-Maclaurin tail: a second form of f, g and h.
struct Sums {
  double f, g, h;
};
Sums partial_fractions(double q) {
  Sums made{};
  const int last = 20001;
  for (int n = last; n >= 1; --n) {
    const double m = kPi2 * n * n, part = 1.0 / (m * (m + q));
    if (n % 2 == 1) made.f += 4.0 * part;
    made.g += 2.0 * part;
    made.h += part / (m + q);
  }
  // Tails: sums of 1/(pi^4 n^4) beyond `last` by the midpoint rule. That of h is below round-off.
  made.f += 4.0 / (kPi2 * kPi2 * 6.0 * std::pow(last + 1.0, 3));
  made.g += 2.0 / (kPi2 * kPi2 * 3.0 * std::pow(last + 0.5, 3));
  return made;
}

TEST(StripBending, IsItsPartialFractionsUnderTensionAndCompression) {
  for (const double q : {-39.0, -28.0, -20.19, -12.0, -10.0, -9.8,  -9.0, -5.0,  -2.001, -1.999,
                         -0.3,  0.0,   1e-9,   0.7,   1.999, 2.001, 30.0, 399.0, 401.0,  1e4}) {
    const StripBending found = StripBending::at(q);
    const Sums sums = partial_fractions(q);
    // Round-off of the closed forms, largest beside q = 2; the sums are good to 1e-15.
    EXPECT_NEAR(found.f / sums.f, 1.0, 5e-12) << q;
    EXPECT_NEAR(found.g / sums.g, 1.0, 5e-12) << q;
    EXPECT_NEAR(found.h / sums.h, 1.0, 5e-12) << q;
  }
}

TEST(StripBending, BowsAgainstItsLoadBelowTheBucklingLoad) {
  for (const double q : {-30.0, -20.0, -10.0}) {
    EXPECT_LT(StripBending::at(q).f, 0.0) << q;
    EXPECT_LT(StripBending::at(q).g, 0.0) << q;
    EXPECT_GT(StripBending::at(q).h, 0.0) << q;
  }
}

TEST(StripBending, HasTheTextbookValuesWithoutTension) {
  const StripBending flat = StripBending::at(0.0);
  EXPECT_NEAR(flat.f * 24.0, 1.0, 1e-15);
  EXPECT_NEAR(flat.g * 45.0, 1.0, 1e-15);
  EXPECT_NEAR(flat.h * 945.0, 1.0, 1e-15);
}

TEST(StripBending, SlopesAreDerivatives) {
  for (const double q :
       {-38.0, -25.0, -11.0, -9.5, -4.0, -1.0, 0.2, 1.5, 3.0, 100.0, 390.0, 410.0, 1e5}) {
    // Of the distance from the nearest pole.
    const double d = 1e-4 * std::min(std::abs(q + kPi2), std::abs(q + 4.0 * kPi2));
    const StripBending at = StripBending::at(q), up = StripBending::at(q + d),
                       down = StripBending::at(q - d);
    // Central differences: truncation (1e-4)^2 times a few, round-off 1e-13/1e-4.
    EXPECT_NEAR((up.f - down.f) / (2.0 * d) / at.f_slope, 1.0, 1e-7) << q;
    EXPECT_NEAR((up.g - down.g) / (2.0 * d) / (-2.0 * at.h), 1.0, 1e-7) << q;
    EXPECT_NEAR((up.h - down.h) / (2.0 * d) / at.h_slope, 1.0, 1e-7) << q;
  }
}

TEST(StripBending, ShapeSolvesTheDifferentialEquationAndItsEdges) {
  for (const double q : {-9.0, -1.0, 0.0, 0.5, 15.9, 16.1, 200.0}) {
    EXPECT_NEAR(strip_shape(q, 0.0) / StripBending::at(q).f, 1.0, 1e-13) << q;
    // Mean by Simpson's rule; error (1/n)^4 u^4/180.
    const int n = 400;
    double sum = 0.0, stretch = 0.0;
    for (int i = 0; i < n; ++i) {
      const double low = double(i) / n, high = double(i + 1) / n;
      sum +=
          (strip_shape(q, low) + 4.0 * strip_shape(q, 0.5 * (low + high)) + strip_shape(q, high)) /
          (6.0 * n);
      const double slope = (strip_shape(q, high) - strip_shape(q, low)) * n;
      stretch += 0.5 * slope * slope / n;
    }
    EXPECT_NEAR(sum / StripBending::at(q).g, 1.0, 1e-6) << q;
    EXPECT_NEAR(stretch / StripBending::at(q).h, 1.0, 2e-3) << q;  // chords: u^2/(12 n^2), edges
    EXPECT_EQ(strip_shape(q, 1.0), 0.0);
    EXPECT_EQ(strip_shape(q, -1.3), 0.0);
    // Clamped: beside the edge W grows as the square of the distance.
    EXPECT_NEAR(strip_shape(q, 1.0 - 1e-4) / strip_shape(q, 1.0 - 2e-4), 0.25, 2e-3) << q;
    // W'''' - q W'' = 1 at s = 0.3 by central differences: h^2/6 of the sixth derivative.
    const double h = 0.005, s = 0.3;
    const auto w = [&](int k) { return strip_shape(q, s + k * h); };
    const double second = (w(1) - 2.0 * w(0) + w(-1)) / (h * h);
    const double fourth = (w(2) - 4.0 * w(1) + 6.0 * w(0) - 4.0 * w(-1) + w(-2)) / std::pow(h, 4);
    EXPECT_NEAR(fourth - q * second, 1.0, 5e-4) << q;
  }
}

}  // namespace
}  // namespace manoscope::wall
