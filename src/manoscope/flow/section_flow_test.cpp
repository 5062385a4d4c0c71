#include "manoscope/flow/section_flow.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "manoscope/core/error.hpp"
#include "manoscope/flow/one_dimensional.hpp"

namespace manoscope::flow {
namespace {

const Channel kChannel{15.5 * mm, 1.7 * mm, 175.0 * um};
const Fluid kWater{1.0 * mPa_s, 998.0 * kg_per_m3};
const FlowRate kFlowRate = 70.0 * mL_per_min;

Array1 bulge(const Array1& x) { return 30e-6 * (1.0 - 0.6 * x / 15.5e-3); }

TEST(SectionFlow, FrictionOfAFlatRoofIsThatOfTheDuct) {
  const Index n = 401;
  const Array1 x = Array1::LinSpaced(n, 0.0, 15.5e-3), zeta = bulge(x);
  const SectionFamily family = SectionFamily::of(kChannel, WallShape::rigid(), zeta);
  const Array1 drop = friction_drop(sections_along(family, x, zeta), kWater, kFlowRate);
  const Array1 duct = one_dimensional_pressure(kChannel, kWater, kFlowRate, x, zeta, Pressure{});
  // The same trapezoid rule; the sections are within 1e-8.
  EXPECT_LT((duct(0) - drop - duct).abs().maxCoeff(), 1e-7 * duct(0));
}

TEST(SectionFlow, MomentumAndEnergyAreBernoulliForAFlatProfile) {
  const Index n = 101;
  const Array1 x = Array1::LinSpaced(n, 0.0, 15.5e-3), zeta = bulge(x);
  const SectionFamily family = SectionFamily::of(kChannel, WallShape::parabola(), zeta);
  SectionsAlong sections = sections_along(family, x, zeta);
  sections.momentum_factor.setOnes();
  sections.energy_factor.setOnes();
  const Array1 speed = kFlowRate.si() / sections.area;
  const Array1 bernoulli = 0.5 * 998.0 * (speed.square() - speed(0) * speed(0));
  EXPECT_LT((momentum_drop(sections, kWater, kFlowRate) - bernoulli).abs().maxCoeff(), 1e-9);
  EXPECT_LT((energy_drop(sections, kWater, kFlowRate) - bernoulli).abs().maxCoeff(), 1e-9);
}

TEST(SectionFlow, MomentumIsTheIntegralOfItsGradient) {
  const Index n = 2001;
  const Array1 x = Array1::LinSpaced(n, 0.0, 15.5e-3), zeta = bulge(x);
  const SectionFamily family = SectionFamily::of(kChannel, WallShape::parabola(), zeta);
  const SectionsAlong sections = sections_along(family, x, zeta);
  const Array1 drop = momentum_drop(sections, kWater, kFlowRate);
  const Array1 flux =
      998.0 * kFlowRate.si() * kFlowRate.si() * sections.momentum_factor / sections.area;
  double sum = 0.0;
  for (Index i = 1; i < n; ++i) {
    sum += 2.0 / (sections.area(i) + sections.area(i - 1)) * (flux(i) - flux(i - 1));
  }
  EXPECT_NEAR(drop(n - 1) / sum, 1.0, 1e-7);  // two rules of second order at 2000 steps
  // It agrees with acceleration_drop() but for the change of beta: 2 % of it, where the squares of
  // speed change by 20 %.
  const double mean = acceleration_drop(kChannel, kWater, kFlowRate, Length::from_si(zeta(0)),
                                        Length::from_si(zeta(n - 1)), 1.25)
                          .si();
  EXPECT_NEAR(drop(n - 1) / mean, 1.0, 0.2);
}

TEST(CompliantPressure, IsThatOfTheMomentumModelInTheShapeItLeaves) {
  const Index n = 801;
  const Array1 x = Array1::LinSpaced(n, 0.0, 15.5e-3);
  const SectionFamily family(kChannel, WallShape::parabola(), -10.0 * um, 80.0 * um);
  const double softness = 33e-6 / 18e3;
  const double l = 15.5e-3, end = 0.6e-3;
  const auto wall = [&](double at, double p) {
    const double a = 1.0 - std::exp(-at / end), b = 1.0 - std::exp(-(l - at) / end);
    const double slope = std::exp(-at / end) / end * b - a * std::exp(-(l - at) / end) / end;
    return WallAnswer{softness * p * a * b, softness * a * b, softness * p * slope};
  };
  const Array1 p = compliant_pressure(family, kChannel, kWater, kFlowRate, x, 500.0 * Pa, wall);
  Array1 zeta(n);
  for (Index i = 0; i < n; ++i) zeta(i) = wall(x(i), p(i)).zeta;
  const SectionsAlong sections = sections_along(family, x, zeta);
  const Array1 drop =
      friction_drop(sections, kWater, kFlowRate) + momentum_drop(sections, kWater, kFlowRate);
  const Array1 again = 500.0 + (drop(n - 1) - drop);
  // The check is by the trapezoid rule on 20 um steps beside ends of 0.6 mm: 1e-4.
  EXPECT_LT((p - again).abs().maxCoeff(), 2e-4 * p.maxCoeff());
}

TEST(CompliantPressure, SaysWhereTheFlowChokes) {
  const Array1 x = Array1::LinSpaced(101, 0.0, 15.5e-3);
  const SectionFamily family(kChannel, WallShape::parabola(), -50.0 * um, 3000.0 * um);
  const auto wall = [](double, double p) { return WallAnswer{5e-9 * p, 5e-9, 0.0}; };
  EXPECT_NO_THROW(
      compliant_pressure(family, kChannel, kWater, 5.0 * mL_per_min, x, Pressure{}, wall));
  try {
    compliant_pressure(family, kChannel, kWater, 300.0 * mL_per_min, x, Pressure{}, wall);
    FAIL() << "a choked flow passed";
  } catch (const InputError& error) {
    EXPECT_NE(error.found().find("chokes at x = 15.5 mm"), std::string::npos) << error.what();
  }
}

TEST(SpeedIndex, IsTheSquareOfSpeedOverPulseSpeedForAFlatProfile) {
  // Pulse speed c^2 = A/(rho dA/dp).
  const double A = 3e-7, compliance = 1e-12, Q = 1e-6;
  const double c2 = A / (998.0 * compliance), U = Q / A;
  EXPECT_NEAR(speed_index(1.0, 0.0, kWater, FlowRate::from_si(Q), A, compliance), U * U / c2,
              1e-12);
}

}  // namespace
}  // namespace manoscope::flow
