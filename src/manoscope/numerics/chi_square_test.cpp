#include "manoscope/numerics/chi_square.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace manoscope::numerics {
namespace {

TEST(ChiSquareTail, IsThatOfTheTables) {
  // Abramowitz & Stegun (1964), table 26.8.
  EXPECT_NEAR(chi_square_tail(3.84146, 1.0), 0.05, 1e-6);
  EXPECT_NEAR(chi_square_tail(23.2093, 10.0), 0.01, 1e-6);
  EXPECT_NEAR(chi_square_tail(149.449, 100.0), 0.001, 1e-6);
  EXPECT_EQ(chi_square_tail(0.0, 5.0), 1.0);
}

TEST(ChiSquareTail, OfTwoDegreesIsAnExponential) {
  for (const double chi_square : {0.1, 3.0, 40.0, 700.0}) {
    EXPECT_NEAR(chi_square_tail(chi_square, 2.0) / std::exp(-0.5 * chi_square), 1.0, 1e-12);
  }
}

TEST(ChiSquareTail, GrowsWithTheDegreesOfFreedomWholeOrNot) {
  double before = 0.0;
  for (double dof = 0.3; dof < 30.0; dof += 0.37) {
    const double tail = chi_square_tail(9.0, dof);
    EXPECT_GT(tail, before);
    before = tail;
  }
}

TEST(ChiSquareTail, EndsFarOutInsteadOfUnderflowing) {
  EXPECT_EQ(chi_square_tail(1e5, 12.0), 0.0);
  EXPECT_EQ(chi_square_tail(1e300, 0.5), 0.0);
}

TEST(SmallestOf, CountsTheTrials) {
  EXPECT_NEAR(smallest_of(0.01, 2.0), 0.0199, 1e-12);
  EXPECT_NEAR(smallest_of(1e-18, 50.0) / 5e-17, 1.0, 1e-12);  // no cancellation
  EXPECT_EQ(smallest_of(1.0, 3.0), 1.0);
  EXPECT_EQ(smallest_of(0.0, 3.0), 0.0);
}

}  // namespace
}  // namespace manoscope::numerics
