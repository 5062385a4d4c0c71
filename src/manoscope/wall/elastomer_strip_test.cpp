#include "manoscope/wall/elastomer_strip.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "manoscope/core/error.hpp"
#include "manoscope/wall/plate_strip.hpp"

namespace manoscope::wall {
namespace {

WallSection silicone(double thickness_um) {
  return {1.7 * mm, thickness_um * um, 1.5 * MPa, 0.49, {}, 5.0 / 6.0};
}

TEST(ElastomerStrip, IsBendingPlusShear) {
  const double a = 0.85e-3, t = 605e-6, e = 1.5e6, nu = 0.49, p = 2e3;
  const double bent = p * std::pow(a, 4) * 12.0 * (1.0 - nu * nu) / (24.0 * e * t * t * t);
  const double sheared = p * a * a / (2.0 * (5.0 / 6.0) * e / (2.0 * (1.0 + nu)) * t);
  const ElastomerStrip law(silicone(605.0));
  EXPECT_NEAR(law.crest(2.0 * kPa).si() / (bent + sheared), 1.0, 1e-14);
  EXPECT_NEAR(law.shear_share(), sheared / (bent + sheared), 1e-14);
  EXPECT_NEAR(law.shear_share(), 0.70, 0.01);  // the docstring's figure
  EXPECT_NEAR(law.pressure(law.crest(2.0 * kPa)).si(), 2e3, 1e-9);
}

TEST(ElastomerStrip, AverageIsTheIntegralOfItsShape) {
  const ElastomerStrip law(silicone(400.0));
  double sum = 0.0;
  const int n = 2000;
  for (int i = 0; i < n; ++i) sum += law.shape(Length{}, (2.0 * i + 1.0) / n - 1.0) / n;
  EXPECT_NEAR(law.mean_over_crest(Length{}) / sum, 1.0, 1e-6);  // midpoint rule, 1/n^2
  EXPECT_EQ(law.shape(Length{}, 0.0), 1.0);
  EXPECT_EQ(law.shape(Length{}, 1.0), 0.0);
}

TEST(ElastomerStrip, IsTheStripsSmallLoadLimitWithinTheStatedError) {
  for (const double thickness : {100.0, 200.0, 605.0}) {
    const ElastomerStrip small(silicone(thickness));
    const PlateStrip exact(silicone(thickness));
    EXPECT_NEAR(exact.crest_compliance(Length{}) / small.crest_compliance(Length{}), 1.0, 1e-12);
    for (const double share : {0.05, 0.1, 0.2}) {
      const Length crest = share * thickness * um;
      const double stiffer = exact.pressure(crest).si() / small.pressure(crest).si() - 1.0;
      EXPECT_GT(stiffer, 0.0);
      EXPECT_LT(stiffer, 0.8 * share * share / (1.0 - small.shear_share())) << thickness;
    }
  }
}

TEST(ElastomerStrip, LeavesOutNoMorePrestressThanStated) {
  for (const double thickness : {200.0, 605.0}) {
    WallSection pulled = silicone(thickness);
    pulled.prestress = 5.0 * kPa;
    const ElastomerStrip small(pulled);
    const double stiffer =
        small.crest_compliance(Length{}) / PlateStrip(pulled).crest_compliance(Length{}) - 1.0;
    const double slenderness = 0.85e-3 / pulled.thickness.si();
    EXPECT_GT(stiffer, 0.0);
    EXPECT_LT(stiffer, 1.2 * 5e3 / pulled.plane_strain_modulus() * slenderness * slenderness /
                           (1.0 - small.shear_share()));
  }
}

TEST(ElastomerStrip, RefusesAWallRigidInShear) {
  WallSection section = silicone(605.0);
  section.shear_correction = 0.0;
  EXPECT_THROW(ElastomerStrip{section}, InputError);
}

}  // namespace
}  // namespace manoscope::wall
