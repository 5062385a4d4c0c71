#include "manoscope/validation/drop_fit.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "manoscope/core/error.hpp"
#include "manoscope/core/random.hpp"

namespace manoscope::validation {
namespace {

std::vector<DropPoint> points(double (*law)(double mL_min)) {
  std::vector<DropPoint> result;
  for (const double q : {5.0, 10.0, 20.0, 40.0, 70.0}) {
    result.push_back({q * mL_per_min, Pressure::from_si(law(q)), 10.0 * Pa});
  }
  return result;
}

TEST(FitQuadratic, FindsFrictionAndInertia) {
  const QuadraticFit fit = fit_quadratic(points([](double q) { return 120.0 * q + 0.4 * q * q; }));
  const double unit = mL_per_min.si();
  EXPECT_NEAR(fit.linear * unit, 120.0, 1e-8);  // exact points: round-off
  EXPECT_NEAR(fit.quadratic * unit * unit, 0.4, 1e-10);
  EXPECT_NEAR(fit.fit.value, 0.0, 1e-12);
  EXPECT_EQ(fit.fit.dof, 3.0);
}

TEST(FitPower, FindsTheExponentOfAWallThatYields) {
  const PowerFit fit = fit_power(points([](double q) { return 200.0 * std::pow(q, 0.85); }));
  EXPECT_NEAR(fit.exponent, 0.85, 1e-12);
  EXPECT_NEAR(fit.at_unit * std::pow(mL_per_min.si(), 0.85), 200.0, 1e-9);
}

TEST(FitQuadratic, StatesTheScatterOfItsParameters) {
  constexpr int kSeeds = 400;
  const double unit = mL_per_min.si();
  double a = 0.0, b = 0.0, n = 0.0;
  for (int seed = 0; seed < kSeeds; ++seed) {
    RandomStream stream(static_cast<std::uint64_t>(seed), "drops");
    auto noisy = points([](double q) { return 120.0 * q + 0.4 * q * q; });
    auto power = points([](double q) { return 200.0 * std::pow(q, 0.85); });
    for (DropPoint& point : noisy) point.drop += stream.normal() * point.uncertainty;
    for (DropPoint& point : power) point.drop += stream.normal() * point.uncertainty;
    const QuadraticFit fit = fit_quadratic(noisy);
    a += std::pow((fit.linear * unit - 120.0) / (fit.linear_uncertainty * unit), 2);
    b += std::pow((fit.quadratic * unit * unit - 0.4) / (fit.quadratic_uncertainty * unit * unit),
                  2);
    const PowerFit line = fit_power(power);
    n += std::pow((line.exponent - 0.85) / line.exponent_uncertainty, 2);
  }
  for (const double squares : {a, b, n}) {  // 1 +- sqrt(2/400): three sigma
    EXPECT_NEAR(squares / kSeeds, 1.0, 0.22);
  }
}

TEST(FitQuadratic, TakesTheScatterWhereNoUncertaintyIsStated) {
  auto noisy = points([](double q) { return 120.0 * q; });
  for (DropPoint& point : noisy) point.uncertainty = Pressure{};
  EXPECT_NEAR(fit_quadratic(noisy).linear_uncertainty * mL_per_min.si(), 0.0, 1e-9);
  noisy[2].drop += 100.0 * Pa;
  EXPECT_GT(fit_quadratic(noisy).linear_uncertainty * mL_per_min.si(), 0.1);
}

TEST(FitQuadratic, RefusesOneFlowRateAndNegativeDrops) {
  const DropPoint one{20.0 * mL_per_min, 1.0 * kPa, 1.0 * Pa};
  EXPECT_THROW(fit_quadratic({one, one}), InputError);
  EXPECT_THROW(fit_quadratic({}), InputError);
  EXPECT_THROW(fit_power({one, {40.0 * mL_per_min, -1.0 * kPa, 1.0 * Pa}}), InputError);
  EXPECT_THROW(fit_quadratic({one, {-40.0 * mL_per_min, 1.0 * kPa, 1.0 * Pa}}), InputError);
}

TEST(FitQuadratic, MeetsSmallDropsAsWellAsLargeOnesWhereNoNoiseIsStated) {
  // Drops that no quadratic meets, Q^1.3 over a decade and more: every point within a few percent.
  std::vector<DropPoint> points;
  for (const double q : {5.0, 10.0, 20.0, 40.0, 70.0}) {
    points.push_back({q * mL_per_min, Pressure::from_si(10.0 * std::pow(q, 1.3)), {}});
  }
  const QuadraticFit fit = fit_quadratic(points);
  for (const DropPoint& point : points) {
    const double Q = point.flow_rate.si();
    EXPECT_NEAR((fit.linear * Q + fit.quadratic * Q * Q) / point.drop.si(), 1.0, 0.1);
  }
}

}  // namespace
}  // namespace manoscope::validation
