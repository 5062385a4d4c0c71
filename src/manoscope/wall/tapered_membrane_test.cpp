#include "manoscope/wall/tapered_membrane.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "manoscope/core/error.hpp"

namespace manoscope::wall {
namespace {

const Membrane kNitride{1.7 * mm, 0.2 * um, 250.0 * GPa, 0.23, 10.0 * MPa};

TEST(TaperedMembrane, IsTheBulgeLawInTheMiddleAndHeldAtItsEnds) {
  const TaperedMembrane wall(15.5 * mm, kNitride);
  const double middle = wall.deflection(7.75e-3, 5000.0);
  const double law = LongMembrane(kNitride).deflection(5.0 * kPa).si();
  EXPECT_NEAR(middle / law, 1.0, 2e-6);  // end layers: 2 e^(-l/2L) = 2 e^(-14.3)
  EXPECT_EQ(wall.deflection(0.0, 5000.0), 0.0);
  EXPECT_EQ(wall.deflection(15.5e-3, 5000.0), 0.0);
  EXPECT_EQ(wall.deflection(-0.2e-3, 5000.0), 0.0);
  EXPECT_EQ(wall.deflection(16e-3, 5000.0), 0.0);
}

TEST(TaperedMembrane, EndLayersAreWidthOverPiLongUnlessToldOtherwise) {
  const double law = LongMembrane(kNitride).deflection(5.0 * kPa).si();
  const TaperedMembrane wall(15.5 * mm, kNitride);
  EXPECT_NEAR(wall.influence_length().si(), 1.7e-3 / std::numbers::pi, 1e-18);
  EXPECT_NEAR(wall.deflection(wall.influence_length().si(), 5000.0) / law, 1.0 - std::exp(-1.0),
              1e-9);
  const TaperedMembrane sharp(15.5 * mm, kNitride, {}, 0.2 * mm);
  EXPECT_NEAR(sharp.deflection(0.2e-3, 5000.0) / law, 1.0 - std::exp(-1.0), 1e-9);
}

TEST(TaperedMembrane, UnderPreloadStartsBowedInwardAndPassesThePlaneAtThatLoad) {
  const TaperedMembrane wall(15.5 * mm, kNitride, {700.0 * Pa, 0.0});
  EXPECT_LT(wall.deflection(7.75e-3, 0.0), -5e-6);
  EXPECT_EQ(wall.deflection(7.75e-3, 700.0), 0.0);
  EXPECT_GT(wall.deflection(7.75e-3, 750.0), 0.0);
  // Odd about the preload.
  EXPECT_NEAR(wall.deflection(7.75e-3, 0.0), -wall.deflection(7.75e-3, 1400.0), 1e-18);
}

TEST(TaperedMembrane, LopsidedPreloadBowsMoreAtTheHeavierEnd) {
  const TaperedMembrane wall(15.5 * mm, kNitride, {700.0 * Pa, 0.1});
  EXPECT_LT(wall.deflection(12e-3, 0.0), wall.deflection(3.5e-3, 0.0));
  EXPECT_EQ(wall.deflection(7.75e-3, 700.0), 0.0);
  // At three quarters the load is 1 + 0.1/4 of its mid value.
  EXPECT_NEAR(wall.deflection(0.75 * 15.5e-3, 700.0 * 1.025), 0.0, 1e-15);
}

TEST(TaperedMembrane, OfManyStationsIsThatOfEach) {
  const TaperedMembrane wall(15.5 * mm, kNitride, {700.0 * Pa, 0.1});
  const Array1 x = Array1::LinSpaced(12, -0.1e-3, 15.6e-3), p = Array1::LinSpaced(12, 9e3, 1e2);
  const Array1 zeta = wall.deflection(x, p), uniform = wall.deflection(x, 2.0 * kPa);
  for (Index i = 0; i < x.size(); ++i) {
    EXPECT_EQ(zeta(i), wall.deflection(x(i), p(i)));
    EXPECT_EQ(uniform(i), wall.deflection(x(i), 2000.0));
  }
}

TEST(TaperedMembrane, ComplianceIsTheSlopeOfTheDeflection) {
  const TaperedMembrane wall(15.5 * mm, kNitride, {700.0 * Pa, 0.1});
  for (const double x : {0.2e-3, 7.75e-3, 15.1e-3}) {
    for (const double p : {0.0, 690.0, 5e3, 40e3}) {
      // Central difference over 0.1 Pa; the curve bends over 60 Pa or more: (0.1/60)^2.
      const double slope = (wall.deflection(x, p + 0.1) - wall.deflection(x, p - 0.1)) / 0.2;
      EXPECT_NEAR(wall.compliance(x, p) / slope, 1.0, 1e-5) << x << " " << p;
    }
  }
  EXPECT_EQ(wall.compliance(0.0, 5e3), 0.0);
  EXPECT_EQ(wall.compliance(16e-3, 5e3), 0.0);
  Membrane slack = kNitride;
  slack.prestress = Pressure{};
  EXPECT_TRUE(std::isinf(TaperedMembrane(15.5 * mm, slack).compliance(7e-3, 0.0)));
}

TEST(TaperedMembrane, RefusesSizesOutOfRange) {
  EXPECT_THROW(TaperedMembrane(Length{}, kNitride), InputError);
  EXPECT_THROW(TaperedMembrane(15.5 * mm, kNitride, {}, -1.0 * mm), InputError);
  EXPECT_THROW(TaperedMembrane(15.5 * mm, kNitride, {700.0 * Pa, 3.0}), InputError);
}

}  // namespace
}  // namespace manoscope::wall
