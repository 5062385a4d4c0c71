#include "manoscope/wall/crest_power.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "manoscope/core/error.hpp"
#include "manoscope/core/random.hpp"

namespace manoscope::wall {
namespace {

HydrostaticData power_law(double scale, double exponent, double noise_p, double noise_z,
                          RandomStream* random) {
  const Index n = 12;
  HydrostaticData data;
  data.pressure = Array1::LinSpaced(n, std::log(1e3), std::log(50e3)).exp();
  data.deflection = scale * data.pressure.pow(exponent);
  data.sigma_pressure = noise_p * data.pressure;
  data.sigma_deflection = noise_z * data.deflection;
  if (random != nullptr) {
    for (Index i = 0; i < n; ++i) {
      data.pressure(i) += data.sigma_pressure(i) * random->normal();
      data.deflection(i) += data.sigma_deflection(i) * random->normal();
    }
  }
  return data;
}

const PressureRange kEverything{1.0 * Pa, 1000.0 * kPa};

TEST(CrestPower, FindsTheExponentOfAPowerLaw) {
  const CrestPower found =
      crest_power(power_law(1e-6, 1.0 / 3.0, 0.01, 0.01, nullptr), kEverything);
  EXPECT_NEAR(found.exponent, 1.0 / 3.0, 1e-12);
  EXPECT_NEAR(found.scale / 1e-6, 1.0, 1e-10);
  EXPECT_EQ(found.n_points, 12);
  EXPECT_NEAR(found.range.low.si(), 1e3, 1e-6);
}

TEST(CrestPower, OfNitrideRunsFromOneToAThird) {
  // S1 of the paper: prestress carries at 100 Pa, stretching at 50 kPa (fig. 1(f)).
  const WallSection nitride{1.7 * mm, 0.2 * um, 250.0 * GPa, 0.23, 50.0 * MPa};
  const PlateStrip law(nitride);
  HydrostaticData data;
  data.pressure = Array1::LinSpaced(60, std::log(1.0), std::log(50e3)).exp();
  data.sigma_pressure = Array1::Zero(60);
  data.deflection = deflection(law, data.pressure);
  data.sigma_deflection = 1e-3 * data.deflection;
  const CrestPower low = crest_power(data, {1.0 * Pa, 5.0 * Pa});
  const CrestPower high = crest_power(data, {20.0 * kPa, 50.0 * kPa});
  EXPECT_NEAR(low.exponent, 1.0, 0.01);
  EXPECT_NEAR(high.exponent, 1.0 / 3.0, 0.02);  // prestress is 5 % of the tension there
  EXPECT_GT(high.exponent, 1.0 / 3.0);
  // Over everything the line does not fit, and says so.
  EXPECT_LT(crest_power(data, kEverything).probability, 1e-6);
}

TEST(CrestPower, PullsAreStandardNormal) {
  RandomStream random(5, "power");
  const int n = 2000;
  double sum = 0.0, squares = 0.0, chi2 = 0.0;
  for (int i = 0; i < n; ++i) {
    const CrestPower found = crest_power(power_law(1e-6, 0.4, 0.02, 0.01, &random), kEverything);
    const double pull = (found.exponent - 0.4) / found.sigma;
    sum += pull;
    squares += pull * pull;
    chi2 += found.chi2 / 10.0;
  }
  // Five standard errors: mean 1/sqrt(n) = 0.022, variance sqrt(2/n) = 0.032, chi2 0.01.
  EXPECT_NEAR(sum / n, 0.0, 0.11);
  EXPECT_NEAR(squares / n, 1.0, 0.16);
  EXPECT_NEAR(chi2 / n, 1.0, 0.05);
}

TEST(CrestPower, RefusesRangesWithoutAPowerLaw) {
  HydrostaticData data = power_law(1e-6, 0.5, 0.0, 0.01, nullptr);
  EXPECT_THROW(crest_power(data, {1.0 * kPa, 1.5 * kPa}), InputError);   // two points
  EXPECT_THROW(crest_power(data, {50.0 * kPa, 1.0 * kPa}), InputError);  // upside down
  data.deflection(3) = -1e-6;  // a wall still bowed inward
  EXPECT_THROW(crest_power(data, kEverything), InputError);
  EXPECT_NO_THROW(crest_power(data, {8.0 * kPa, 60.0 * kPa}));
}

}  // namespace
}  // namespace manoscope::wall
