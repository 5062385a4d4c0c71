#include "manoscope/wall/choose_law.hpp"

#include <gtest/gtest.h>

#include "manoscope/core/error.hpp"
#include "manoscope/core/random.hpp"

namespace manoscope::wall {
namespace {

const std::vector<LawKind> kStrips = {LawKind::long_membrane, LawKind::plate_strip,
                                      LawKind::elastomer_strip};

HydrostaticData virtual_data(const WallSection& truth, double highest, RandomStream& random) {
  const PlateStrip law(truth);  // exact for every strip
  const Index n = 12;
  HydrostaticData data;
  data.pressure = Array1::LinSpaced(n, 0.05 * highest, highest);
  data.deflection = deflection(law, data.pressure);
  data.sigma_pressure = Array1::Constant(n, 1e-3 * highest);
  data.sigma_deflection = Array1::Constant(n, 2e-3 * data.deflection.maxCoeff());
  for (Index i = 0; i < n; ++i) {
    data.pressure(i) += data.sigma_pressure(i) * random.normal();
    data.deflection(i) += data.sigma_deflection(i) * random.normal();
  }
  return data;
}

TEST(ChooseLaw, TakesTheElastomerForAThickWallAndNotForAThinOne) {
  RandomStream random(8, "choose");
  // S5 of the paper at 4 kPa, about 12 um of 605: stretching adds 0.1 %, half a sigma.
  const WallSection thick{1.7 * mm, 605.0 * um, 1.5 * MPa, 0.49, {}, 5.0 / 6.0};
  // Nitride whose deflection goes with the cube root.
  const WallSection thin{1.7 * mm, 0.2 * um, 250.0 * GPa, 0.23, 50.0 * MPa, 5.0 / 6.0};
  int elastomer = 0;
  const int n_draws = 40;
  for (int i = 0; i < n_draws; ++i) {
    const LawChoice linear = choose_law(kStrips, thick, virtual_data(thick, 4e3, random));
    elastomer += linear.best().kind == LawKind::elastomer_strip;
    const LawChoice cubic = choose_law(kStrips, thin, virtual_data(thin, 20e3, random));
    EXPECT_NE(cubic.best().kind, LawKind::elastomer_strip);
    EXPECT_LT(cubic.weights(cubic.weights.size() - 1), 1e-6);  // the linear law, far behind
    EXPECT_NEAR(cubic.weights.sum(), 1.0, 1e-12);
    for (std::size_t k = 1; k < cubic.fits.size(); ++k) {
      EXPECT_GE(cubic.fits[k].aicc, cubic.fits[k - 1].aicc);
    }
  }
  // A second parameter wins where it lowers chi2 by more than its price of 2.9 (n = 12): 9 % of
  // the draws for each of two rivals.
  EXPECT_GE(elastomer, 28);
}

TEST(ChooseLaw, SaysWhenNoLawHolds) {
  RandomStream random(9, "adequate");
  const WallSection thin{1.7 * mm, 0.2 * um, 250.0 * GPa, 0.23, 50.0 * MPa};
  HydrostaticData data = virtual_data(thin, 20e3, random);
  EXPECT_TRUE(choose_law(kStrips, thin, data).adequate);
  data.deflection(6) += 20.0 * data.sigma_deflection(6);  // an outlier no law explains
  EXPECT_FALSE(choose_law(kStrips, thin, data).adequate);
}

TEST(ChooseLaw, KeepsTheReasonsOfLawsThatCouldNotBeFitted) {
  RandomStream random(10, "refused");
  const WallSection rigid{1.7 * mm, 0.2 * um, 250.0 * GPa, 0.23, 50.0 * MPa};  // no shear given
  const HydrostaticData data = virtual_data(rigid, 20e3, random);
  const LawChoice choice = choose_law(kStrips, rigid, data);
  ASSERT_EQ(choice.refused.size(), 1U);
  EXPECT_EQ(choice.refused[0].kind, LawKind::elastomer_strip);
  EXPECT_NE(choice.refused[0].reason.find("shear"), std::string::npos);
  EXPECT_EQ(choice.fits.size(), 2U);
  EXPECT_THROW(choose_law({}, rigid, data), InputError);
  EXPECT_THROW(choose_law({LawKind::elastomer_strip}, rigid, data), InputError);
}

}  // namespace
}  // namespace manoscope::wall
