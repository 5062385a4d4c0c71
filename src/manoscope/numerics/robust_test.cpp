#include "manoscope/numerics/robust.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "manoscope/core/random.hpp"

namespace manoscope::numerics {
namespace {

TEST(Median, IsTheMiddleOrTheMeanOfTheMiddleTwo) {
  std::vector<double> odd{5.0, 1.0, 3.0}, even{4.0, 1.0, 3.0, 2.0}, one{7.0};
  EXPECT_EQ(median(odd), 3.0);
  EXPECT_EQ(median(even), 2.5);
  EXPECT_EQ(median(one), 7.0);
}

TEST(MadSigma, FindsTheNoiseUnderOutliers) {
  RandomStream stream(1, "mad");
  std::vector<double> values(20000);
  for (double& value : values) value = 2.0 * stream.normal();
  for (std::size_t i = 0; i < values.size(); i += 20) values[i] += 1000.0;
  // 5 % one-sided outliers move the quantile of the rest by about 6 %.
  EXPECT_NEAR(mad_sigma(values, 0.0), 2.0, 0.2);
}

}  // namespace
}  // namespace manoscope::numerics
