#include "manoscope/flow/pressure_term.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "manoscope/flow/passage_losses.hpp"

namespace manoscope::flow {
namespace {

PressureTerm term(const std::string& formula, double drop, double uncertainty, double viscous) {
  PressureTerm one;
  one.name = one.formula = formula;
  one.drop = drop * Pa;
  one.uncertainty = uncertainty * Pa;
  one.by_viscosity = viscous * Pa;
  one.by_flow_rate = (2.0 * drop - viscous) * Pa;
  return one;
}

TEST(ParasiticEstimate, AddsErrorsOfOneFormulaAndSquaresThoseOfDifferentOnes) {
  const std::vector<PressureTerm> terms{term("steps", 100.0, 10.0, 100.0),
                                        term("steps", 100.0, 20.0, 100.0),
                                        term("bends", 50.0, 40.0, 50.0)};
  EXPECT_NEAR(parasitic_estimate(terms, {}).standard_uncertainty(), 50.0, 1e-12);  // 30 and 40
}

TEST(ParasiticEstimate, TakesFlowRateOnceForFrictionAndTwiceForInertia) {
  const std::vector<PressureTerm> terms{term("duct", 300.0, 0.0, 300.0),
                                        term("contraction", 100.0, 0.0, 0.0)};
  EXPECT_NEAR(parasitic_estimate(terms, {0.02, 0.0}).standard_uncertainty(), 10.0, 1e-12);
  EXPECT_NEAR(parasitic_estimate(terms, {0.0, 0.01}).standard_uncertainty(), 3.0, 1e-12);
}

TEST(ParasiticEstimate, SharesTheHeightOfBothPassages) {
  std::vector<PressureTerm> terms{term("duct", 300.0, 0.0, 300.0), term("duct", 300.0, 0.0, 300.0)};
  for (PressureTerm& one : terms) one.height_effect = -9.0 * Pa;
  EXPECT_NEAR(parasitic_estimate(terms, {}).standard_uncertainty(), 18.0, 1e-12);
}

TEST(ParasiticEstimate, OfTwoPassagesInARowHasTwiceTheErrorOfOne) {
  PassageFittings fittings;
  fittings.from_reservoir = fittings.into_reservoir = true;
  fittings.mitre_bends = 1;
  auto terms = passage_terms({1.0 * mPa_s, 998.0 * kg_per_m3}, 20.0 * mL_per_min,
                             {5.0 * mm, 1.7 * mm, 175.0 * um}, fittings);
  const double one = parasitic_estimate(terms, {}).standard_uncertainty();
  const auto again = terms;
  terms.insert(terms.end(), again.begin(), again.end());
  EXPECT_NEAR(parasitic_estimate(terms, {}).standard_uncertainty() / one, 2.0, 1e-12);
}

TEST(CompliantDrop, SubtractsWithTheUncertaintiesOfAllTerms) {
  const std::vector<PressureTerm> terms{term("duct", 300.0, 0.0, 300.0),
                                        term("bends", 100.0, 40.0, 100.0)};
  const Estimate drop =
      compliant_drop(2000.0 * Pa, 30.0 * Pa, parasitic_estimate(terms, {0.0, 0.01}));
  EXPECT_DOUBLE_EQ(drop.value, 1600.0);
  EXPECT_NEAR(drop.standard_uncertainty(), std::hypot(30.0, 40.0, 4.0), 1e-12);
}

TEST(CompliantDrop, OfATransducerOfUnknownNoiseHasNoKnownUncertainty) {
  const auto parasitic = parasitic_estimate({term("duct", 300.0, 3.0, 300.0)}, {});
  EXPECT_TRUE(std::isnan(compliant_drop(2000.0 * Pa, {}, parasitic).standard_uncertainty()));
  // Stated as exact is known.
  EXPECT_EQ(compliant_drop(2000.0 * Pa, Pressure{}, parasitic).standard_uncertainty(), 3.0);
}

}  // namespace
}  // namespace manoscope::flow
