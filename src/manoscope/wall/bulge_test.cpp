#include "manoscope/wall/bulge.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "manoscope/core/error.hpp"
#include "manoscope/core/random.hpp"

namespace manoscope::wall {
namespace {

Membrane nitride() { return {1.7 * mm, 0.2 * um, 250.0 * GPa, 0.23, 100.0 * MPa}; }

TEST(LongMembrane, IsTheBulgeFormula) {
  // Written out with other groupings than the code: N = s0 t + E' t (2/3)(z/a)^2, p = 2 N z/a^2.
  const double z = 30e-6, a = 0.85e-3, t = 0.2e-6, modulus = 250e9 / (1.0 - 0.23 * 0.23);
  const double tension = 100e6 * t + modulus * t * 2.0 / 3.0 * (z / a) * (z / a);
  EXPECT_NEAR(LongMembrane(nitride()).pressure(30.0 * um).si(), 2.0 * tension * z / (a * a), 1e-8);
}

TEST(LongMembrane, StrainOfTheParabolaIsItsArcLengthWithinTheStatedError) {
  // Exact arc of a parabola of half-width 1 and crest d, against the second-order 2/3 d^2.
  for (const double d : {0.05, 0.1, 0.2}) {
    const double arc = 0.5 * std::sqrt(1.0 + 4.0 * d * d) + std::asinh(2.0 * d) / (4.0 * d);
    const double error = (arc - 1.0) / (2.0 / 3.0 * d * d) - 1.0;
    EXPECT_LT(error, 0.0);
    EXPECT_LT(-error, 0.8 * d * d) << "z/a = " << d;  // the bound of the docstring
  }
}

TEST(LongMembrane, InverseGivesBackThePressureForAnyMembrane) {
  RandomStream random(11, "membranes");
  for (int i = 0; i < 2000; ++i) {
    Membrane membrane = nitride();
    membrane.thickness = std::pow(10.0, random.uniform(-1.0, 3.0)) * um;
    membrane.youngs_modulus = std::pow(10.0, random.uniform(5.0, 11.5)) * Pa;
    membrane.prestress = i % 10 == 0 ? Pressure{} : std::pow(10.0, random.uniform(-3.0, 9.0)) * Pa;
    const LongMembrane wall(membrane);
    const double p = (random.uniform() < 0.5 ? -1.0 : 1.0) * std::pow(10.0, random.uniform(-3, 6));
    const double z = wall.crest(Pressure::from_si(p)).si();
    // Round-off only: the pressure of the root, conditioned by at most d ln p / d ln z = 3.
    EXPECT_NEAR(wall.pressure(Length::from_si(z)).si() / p, 1.0, 1e-14) << "draw " << i;
  }
}

TEST(LongMembrane, DeflectsMoreForMorePressureAndOddly) {
  const LongMembrane wall(nitride());
  double before = -1.0;
  for (double p = -1e4; p <= 1e4; p += 100.0) {
    const double z = wall.crest(Pressure::from_si(p)).si();
    EXPECT_GT(z, before);
    EXPECT_EQ(z, -wall.crest(Pressure::from_si(-p)).si());
    before = z;
  }
  EXPECT_EQ(wall.crest(Pressure{}).si(), 0.0);
}

TEST(LongMembrane, FollowsTheCubeRootAtHighPressure) {
  Membrane slack = nitride();
  slack.prestress = 1.0 * MPa;
  const LongMembrane wall(slack);
  const double slope =
      std::log(wall.crest(1.01 * MPa).si() / wall.crest(1.0 * MPa).si()) / std::log(1.01);
  // Prestress holds 5.5e5 Pa/m * 2e-4 m = 110 Pa of 1 MPa: slope 1/3 up to a few 1e-5.
  EXPECT_NEAR(slope, 1.0 / 3.0, 1e-4);
  const double linear =
      std::log(wall.crest(1.01e-4 * Pa).si() / wall.crest(1e-4 * Pa).si()) / std::log(1.01);
  EXPECT_NEAR(linear, 1.0, 1e-7);  // stretching adds 2 cubic z^2/linear = 2e-8
}

TEST(LongMembrane, ComplianceIsTheDerivative) {
  const LongMembrane wall(nitride());
  for (const double p : {-3000.0, 10.0, 700.0, 50000.0}) {
    const double step = 1e-4 * std::abs(p);
    const double difference = (wall.crest(Pressure::from_si(p + step)).si() -
                               wall.crest(Pressure::from_si(p - step)).si()) /
                              (2.0 * step);
    // Central difference: truncation (1e-4)^2 of order one, round-off 1e-16/1e-4.
    EXPECT_NEAR(wall.crest_compliance(wall.crest(Pressure::from_si(p))) / difference, 1.0, 2e-8);
  }
}

TEST(LongMembrane, WidthAverageIsTheIntegralOfItsParabola) {
  const LongMembrane wall(nitride());
  const double crest = wall.crest(5.0 * kPa).si();
  double sum = 0.0;
  const int n = 2000;
  for (int i = 0; i < n; ++i) {
    const double s = (2.0 * i + 1.0) / n - 1.0;
    sum += crest * (1.0 - s * s) / n;
  }
  EXPECT_NEAR(wall.deflection(5.0 * kPa).si() / sum, 1.0, 1e-6);  // midpoint rule: 1/(2 n^2)
}

TEST(LongMembrane, OfManyPressuresIsThatOfEach) {
  const LongMembrane wall(nitride());
  const Array1 p = Array1::LinSpaced(9, -500.0, 5000.0), z = wall.crest(p);
  for (Index i = 0; i < p.size(); ++i) EXPECT_EQ(z(i), wall.crest(Pressure::from_si(p(i))).si());
}

TEST(LongMembrane, RefusesWhatIsNoMembrane) {
  const auto refused = [](auto change) {
    Membrane membrane = nitride();
    change(membrane);
    EXPECT_THROW(LongMembrane{membrane}, InputError);
  };
  refused([](Membrane& w) { w.thickness = -0.2 * um; });
  refused([](Membrane& w) { w.width = Length{}; });
  refused([](Membrane& w) { w.youngs_modulus = Pressure{}; });
  refused([](Membrane& w) { w.poisson_ratio = 0.6; });
  refused([](Membrane& w) { w.prestress = -1.0 * MPa; });
}

}  // namespace
}  // namespace manoscope::wall
