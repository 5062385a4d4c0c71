#include "manoscope/numerics/ranks.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "manoscope/core/random.hpp"

namespace manoscope::numerics {
namespace {

/// Sizes of normal noise, a few of them far off.
std::vector<double> sizes(std::size_t n, const std::string& name) {
  RandomStream stream(12, name);
  std::vector<double> values;
  for (std::size_t i = 0; i < n; ++i) {
    values.push_back(std::abs(stream.normal()) * (i % 50 == 0 ? 100.0 : 1.0));
  }
  return values;
}

TEST(ValuesOfRanks, AreThoseOfTheSortedValues) {
  for (const std::size_t n : {1U, 2U, 513U, 1000U, 4001U}) {
    const std::vector<double> values = sizes(n, "sorted");
    std::vector<double> sorted = values;
    std::sort(sorted.begin(), sorted.end());
    for (const Range within : {Range{0.0, 600.0}, Range{sorted.front(), sorted.back()},
                               Range{0.5, 0.6}, Range{-2.0, -1.0}}) {
      for (const std::size_t rank : {std::size_t{0}, n / 3, n / 2, n - 1}) {
        std::vector<double> space = values;
        const Range one = values_of_ranks(space, rank, rank, within);
        EXPECT_EQ(one.low, sorted[rank]);
        EXPECT_EQ(one.high, sorted[rank]);
        if (rank == 0) continue;
        space = values;
        const Range two = values_of_ranks(space, rank - 1, rank, within);
        EXPECT_EQ(two.low, sorted[rank - 1]);
        EXPECT_EQ(two.high, sorted[rank]);
      }
    }
  }
}

TEST(ValuesOfRanks, TakeEqualValuesAndARangeOfAnyWidth) {
  std::vector<double> equal(1000, 2.0);
  EXPECT_EQ(values_of_ranks(equal, 499, 500, {2.0, 2.0}).low, 2.0);
  EXPECT_EQ(values_of_ranks(equal, 499, 500, {0.0, 1e200}).high, 2.0);
  std::vector<double> two(1000, 0.0);
  std::fill(two.begin() + 500, two.end(), 1e-300);
  const Range middle = values_of_ranks(two, 499, 500, {0.0, 1e-300});
  EXPECT_EQ(middle.low, 0.0);
  EXPECT_EQ(middle.high, 1e-300);
}

TEST(RangeOfRanks, HoldsThemAndLittleMore) {
  const std::vector<double> values = sizes(4000, "range");
  std::vector<double> sorted = values;
  std::sort(sorted.begin(), sorted.end());
  const auto range = range_of_ranks(values, 1873, 2127, {0.0, 2.0});
  ASSERT_TRUE(range);
  EXPECT_LE(range->low, sorted[1873]);
  EXPECT_GE(range->high, sorted[2127]);
  EXPECT_GE(range->low, sorted[1873] - 3 * 2.0 / 256);  // three parts at most
  EXPECT_LE(range->high, sorted[2127] + 3 * 2.0 / 256);
}

TEST(RangeOfRanks, IsNotKnownWhereTheyLieBeyondWhatIsLookedAt) {
  const std::vector<double> values = sizes(4000, "range");
  EXPECT_FALSE(range_of_ranks(values, 1873, 2127, {0.0, 0.5}));
  EXPECT_FALSE(range_of_ranks(values, 1873, 2127, {0.8, 2.0}));
  EXPECT_FALSE(range_of_ranks(values, 1873, 2127, {0.7, 0.7}));
}

}  // namespace
}  // namespace manoscope::numerics
