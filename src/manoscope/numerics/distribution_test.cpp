#include "manoscope/numerics/distribution.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <boost/math/distributions/exponential.hpp>
#include <boost/math/distributions/gamma.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "manoscope/core/error.hpp"

namespace manoscope::numerics {
namespace {

struct Known {
  const char* name;
  Distribution distribution;
  std::function<double(double)> cumulative;
};

/// Cumulative distribution of a trapezoid on [0, 1]; `top` as in Distribution::trapezoidal.
double trapezoid_cumulative(double x, double top) {
  const double half = std::min(x, 1.0 - x), foot = 0.5 * (1.0 - top), height = 2.0 / (1.0 + top);
  const double below =
      half < foot ? 0.5 * height * half * half / foot : height * (half - 0.5 * foot);
  return x < 0.5 ? below : 1.0 - below;
}

std::vector<Known> known() {
  namespace bm = boost::math;
  return {
      {"normal", Distribution::normal(3.0, 2.0),
       [](double x) { return bm::cdf(bm::normal(3.0, 2.0), x); }},
      {"rectangular", Distribution::rectangular(-1.0, 3.0),
       [](double x) { return std::clamp((x + 1.0) / 4.0, 0.0, 1.0); }},
      {"triangular", Distribution::triangular(-1.0, 3.0),
       [](double x) { return trapezoid_cumulative((x + 1.0) / 4.0, 0.0); }},
      {"trapezoidal", Distribution::trapezoidal(-1.0, 3.0, 0.25),
       [](double x) { return trapezoid_cumulative((x + 1.0) / 4.0, 0.25); }},
      {"arcsine", Distribution::arcsine(-1.0, 3.0),
       [](double x) { return 0.5 + std::asin((x - 1.0) / 2.0) / std::numbers::pi; }},
      {"t, 5 degrees of freedom", Distribution::student_t(3.0, 2.0, 5.0),
       [](double x) { return bm::cdf(bm::students_t(5.0), (x - 3.0) / 2.0); }},
      {"t, 1.5 degrees of freedom", Distribution::student_t(3.0, 2.0, 1.5),
       [](double x) { return bm::cdf(bm::students_t(1.5), (x - 3.0) / 2.0); }},
      {"exponential", Distribution::exponential(2.0),
       [](double x) { return bm::cdf(bm::exponential(0.5), x); }},
      {"gamma", Distribution::gamma(4.0, 0.5),
       [](double x) { return bm::cdf(bm::gamma_distribution(4.0, 0.5), x); }},
      {"gamma of shape below 1", Distribution::gamma(0.3, 2.0),
       [](double x) { return bm::cdf(bm::gamma_distribution(0.3, 2.0), x); }},
  };
}

TEST(Distribution, DrawsFollowTheCumulativeDistribution) {
  constexpr int kDraws = 100'000;
  for (const Known& one : known()) {
    RandomStream random(1, one.name);
    std::vector<double> drawn;
    for (int i = 0; i < kDraws; ++i) drawn.push_back(one.distribution.draw(random));
    std::sort(drawn.begin(), drawn.end());
    double farthest = 0.0;
    for (int i = 0; i < kDraws; ++i) {
      const double should = one.cumulative(drawn[static_cast<std::size_t>(i)]);
      farthest =
          std::max({farthest, should - i / double(kDraws), (i + 1) / double(kDraws) - should});
    }
    // Kolmogorov-Smirnov: beyond 1.95/sqrt(n) with probability 0.001 (2 exp(-2 * 1.95^2)).
    EXPECT_LT(farthest, 1.95 / std::sqrt(kDraws)) << one.name;
  }
}

TEST(Distribution, StatesTheMeanAndTheStandardDeviationOfItsDraws) {
  constexpr int kDraws = 200'000;
  std::vector<Known> all = known();
  all.push_back({"limits in doubt", Distribution::doubtful_rectangular(-1.0, 3.0, 0.8), {}});
  for (const Known& one : all) {
    if (std::isinf(one.distribution.sigma())) continue;  // t with 1.5 degrees of freedom
    RandomStream random(2, one.name);
    double sum = 0.0, squares = 0.0, fourths = 0.0;
    for (int i = 0; i < kDraws; ++i) {
      const double off = one.distribution.draw(random) - one.distribution.mean();
      sum += off;
      squares += off * off;
      fourths += off * off * off * off;
    }
    const double variance = squares / kDraws;
    // 4 sigma of a mean and of a variance, the latter from the sample's fourth moment.
    EXPECT_NEAR(sum / kDraws, 0.0, 4.0 * std::sqrt(variance / kDraws)) << one.name;
    const double of_variance = std::sqrt((fourths / kDraws - variance * variance) / kDraws);
    EXPECT_NEAR(variance, std::pow(one.distribution.sigma(), 2), 4.0 * of_variance) << one.name;
  }
}

TEST(Distribution, RefusesParametersOutOfRange) {
  EXPECT_THROW(Distribution::normal(0.0, -1.0), InputError);
  EXPECT_THROW(Distribution::rectangular(1.0, 1.0), InputError);
  EXPECT_THROW(Distribution::doubtful_rectangular(0.0, 1.0, 0.6), InputError);
  EXPECT_THROW(Distribution::trapezoidal(0.0, 1.0, 1.1), InputError);
  EXPECT_THROW(Distribution::arcsine(2.0, 1.0), InputError);
  EXPECT_THROW(Distribution::student_t(0.0, 0.0, 3.0), InputError);
  EXPECT_THROW(Distribution::student_t(0.0, 1.0, 0.0), InputError);
  EXPECT_THROW(Distribution::exponential(0.0), InputError);
  EXPECT_THROW(Distribution::gamma(0.0, 1.0), InputError);
}

}  // namespace
}  // namespace manoscope::numerics
