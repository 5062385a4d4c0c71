#include "manoscope/flow/passage_losses.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "manoscope/core/error.hpp"

namespace manoscope::flow {
namespace {

constexpr RigidPassage kPassage{5.0 * mm, 1.7 * mm, 175.0 * um};
constexpr Fluid kWater{1.0 * mPa_s, 998.0 * kg_per_m3};
constexpr FlowRate kFlow = 70.0 * mL_per_min;

double head() {  // rho U^2/2 by hand
  const double speed = 70e-6 / 60.0 / (1.7e-3 * 175e-6);
  return 0.5 * 998.0 * speed * speed;
}

double drop(const std::vector<PressureTerm>& terms, const std::string& name) {
  const auto found = std::find_if(terms.begin(), terms.end(),
                                  [&](const PressureTerm& term) { return term.name == name; });
  if (found == terms.end()) throw std::out_of_range(name);
  return found->drop.si();
}

TEST(PassageTerms, AreTheDuctAloneWithoutFittings) {
  const auto terms = passage_terms(kWater, kFlow, kPassage, {});
  ASSERT_EQ(terms.size(), 1U);
  EXPECT_EQ(terms[0].drop, passage_drop(kWater.viscosity, kFlow, kPassage));
  EXPECT_EQ(terms[0].uncertainty, Pressure{});
}

TEST(PassageTerms, OfAReservoirTakeTheKineticEnergyAndGiveNothingBack) {
  PassageFittings ends;
  ends.from_reservoir = ends.into_reservoir = true;
  const auto terms = passage_terms(kWater, kFlow, kPassage, ends);
  EXPECT_NEAR(drop(terms, "contraction") / head(), 1.0, 1e-12);  // Bernoulli; round-off
  EXPECT_EQ(drop(terms, "expansion"), 0.0);                      // all kinetic energy is lost
}

TEST(PassageTerms, OfALongDuctDevelopByItsIncrementalDrop) {
  // K(inf) of gap/width 0.103 lies between 0.674 (plates) and 0.931 (0.2): Shah's table.
  RigidPassage longest = kPassage;
  longest.length = 1000.0 * mm;
  PassageFittings ends;
  ends.from_reservoir = true;
  const double K = drop(passage_terms(kWater, kFlow, longest, ends), "development") / head();
  EXPECT_GT(K, 0.674);
  EXPECT_LT(K, 0.931);
}

TEST(PassageTerms, OfAnExpansionFollowTheMomentumBalance) {
  // Plates in the limit of a wide passage: beta = 6/5, so at sigma = 1/2 a rise of
  // rho U^2 * 0.5 * 1.2 * 0.5 = 0.6 rho U^2/2. Sides take beta up by about h/w.
  const RigidPassage wide{5.0 * mm, 40.0 * mm, 175.0 * um};
  PassageFittings ends;
  ends.into = 2.0 * (wide.width * wide.height);
  const double speed = 70e-6 / 60.0 / (40e-3 * 175e-6);
  EXPECT_NEAR(
      drop(passage_terms(kWater, kFlow, wide, ends), "expansion") / (0.5 * 998.0 * speed * speed),
      -0.6, 0.005);
}

TEST(PassageTerms, OfTwoEndsInCreepingFlowAreSampsons) {
  // A square of 100 um, R = 50 um: 3 eta Q/R^3 by hand at 1 uL/min.
  PassageFittings ends;
  ends.from_reservoir = ends.into_reservoir = true;
  const auto terms =
      passage_terms(kWater, 1e-3 * mL_per_min, {1.0 * mm, 100.0 * um, 100.0 * um}, ends);
  const double by_hand = 3.0 * 1e-3 * (1e-9 / 60.0) / std::pow(50e-6, 3);
  EXPECT_NEAR((drop(terms, "step at the entry") + drop(terms, "step at the exit")) / by_hand, 1.0,
              1e-12);
}

TEST(PassageTerms, OfBendsAreBetweenNothingAndTwice) {
  PassageFittings bends;
  bends.mitre_bends = 2;
  const auto terms = passage_terms(kWater, kFlow, kPassage, bends);
  const double speed = 70e-6 / 60.0 / (1.7e-3 * 175e-6);
  const double diameter = 2.0 * 1.7e-3 * 175e-6 / (1.7e-3 + 175e-6);
  const double reynolds = speed * diameter / (1e-3 / 998.0);
  EXPECT_NEAR(terms.back().drop.si() / head(), 2.0 * (1000.0 / reynolds + 1.15), 1e-12);
  EXPECT_NEAR(terms.back().uncertainty / terms.back().drop, 1.0 / std::sqrt(3.0), 1e-12);
}

TEST(PassageTerms, RefuseASectionThatIsSmallerThanThePassage) {
  PassageFittings ends;
  ends.from = 0.5 * (kPassage.width * kPassage.height);
  EXPECT_THROW(passage_terms(kWater, kFlow, kPassage, ends), InputError);
  ends = {};
  ends.round_bends = -1;
  EXPECT_THROW(passage_terms(kWater, kFlow, kPassage, ends), InputError);
  EXPECT_THROW(passage_terms(kWater, -kFlow, kPassage, {}), InputError);
}

TEST(SimulatedDrop, FollowsFrictionAndInertia) {
  const auto law = [](double q) { return Pressure::from_si(40.0 * q + 0.3 * q * q); };  // mL/min
  std::vector<SimulatedDrop> simulations;
  for (const double q : {10.0, 40.0, 70.0})
    simulations.push_back({q * mL_per_min, law(q), 5.0 * Pa});
  EXPECT_NEAR(simulated_drop(simulations, 55.0 * mL_per_min).drop / law(55.0), 1.0, 1e-10);
  // At the one simulation that weighs most the error cannot exceed its own.
  const double u = simulated_drop(simulations, 70.0 * mL_per_min).uncertainty.si();
  EXPECT_LT(u, 5.0);
  EXPECT_GT(u, 4.0);
}

TEST(SimulatedDrop, RefusesToReachBeyondItsSimulations) {
  const std::vector<SimulatedDrop> one{{20.0 * mL_per_min, 1.0 * kPa, 10.0 * Pa}};
  EXPECT_EQ(simulated_drop(one, 20.0 * mL_per_min).uncertainty, 10.0 * Pa);
  EXPECT_THROW(simulated_drop(one, 10.0 * mL_per_min), InputError);
  EXPECT_THROW(simulated_drop({}, 10.0 * mL_per_min), InputError);
  EXPECT_THROW(simulated_drop({one[0], one[0]}, 10.0 * mL_per_min), InputError);
}

TEST(CompliantDrop, SubtractsWithTheUncertaintiesOfAllTerms) {
  const std::vector<PressureTerm> terms{{"duct", "", 300.0 * Pa, Pressure{}},
                                        {"bends", "", 100.0 * Pa, 40.0 * Pa}};
  const Estimate drop = compliant_drop(2000.0 * Pa, 30.0 * Pa, parasitic_estimate(terms, 0.01));
  EXPECT_DOUBLE_EQ(drop.value, 1600.0);
  EXPECT_NEAR(drop.standard_uncertainty(), std::hypot(30.0, 40.0, 4.0), 1e-12);
}

}  // namespace
}  // namespace manoscope::flow
