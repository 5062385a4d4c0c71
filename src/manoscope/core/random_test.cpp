#include "manoscope/core/random.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace manoscope {
namespace {

TEST(RandomStream, GivesTheSameNumbersForTheSameNameOnly) {
  RandomStream a(1, "pixel noise", 3), b(1, "pixel noise", 3), c(1, "pixel noise", 4),
      d(2, "pixel noise", 3), e(1, "tilt", 3);
  const double first = a.uniform();
  EXPECT_EQ(first, b.uniform());
  EXPECT_NE(first, c.uniform());
  EXPECT_NE(first, d.uniform());
  EXPECT_NE(first, e.uniform());
}

TEST(RandomStream, NormalVariatesHaveTheirMoments) {
  RandomStream stream(7, "moments");
  constexpr int kDraws = 200000;
  double sum = 0.0, squares = 0.0, fourths = 0.0;
  for (int i = 0; i < kDraws; ++i) {
    const double value = stream.normal();
    sum += value;
    squares += value * value;
    fourths += std::pow(value, 4);
  }
  // Five standard errors of each moment of a seeded draw: variances 1, 2 and 96.
  const double n = kDraws;
  EXPECT_NEAR(sum / n, 0.0, 5.0 * std::sqrt(1.0 / n));
  EXPECT_NEAR(squares / n, 1.0, 5.0 * std::sqrt(2.0 / n));
  EXPECT_NEAR(fourths / n, 3.0, 5.0 * std::sqrt(96.0 / n));
}

TEST(RandomStream, DrawsEveryIntegerBelowItsBound) {
  RandomStream stream(7, "integers");
  int counts[5] = {};
  for (int i = 0; i < 5000; ++i) ++counts[stream.below(5)];
  for (const int count : counts) EXPECT_NEAR(count, 1000, 5 * std::sqrt(800.0));  // binomial
}

}  // namespace
}  // namespace manoscope
