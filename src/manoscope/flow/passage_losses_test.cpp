#include "manoscope/flow/passage_losses.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "manoscope/core/error.hpp"

namespace manoscope::flow {
namespace {

constexpr RigidPassage kPassage{5.0 * mm, 1.7 * mm, 175.0 * um};
constexpr Fluid kWater{1.0 * mPa_s, 998.0 * kg_per_m3};
constexpr FlowRate kFlow = 70.0 * mL_per_min;
constexpr PassageFittings kReservoirs{{}, true, {}, true};

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

TEST(PassageTerms, OfTwoEndsOfASlitAreHasimotosWithinAnEllipsesError) {
  // 32 eta (Q/w)/(pi h^2) for both by hand; the ends of the slit and the ellipse add 6 %.
  const auto terms = passage_terms(kWater, kFlow, kPassage, kReservoirs);
  const double by_hand =
      32.0 * 1e-3 * (70e-6 / 60.0 / 1.7e-3) / (std::numbers::pi * 175e-6 * 175e-6);
  EXPECT_NEAR((drop(terms, "step at the entry") + drop(terms, "step at the exit")) / by_hand, 1.0,
              0.10);
}

TEST(PassageTerms, OfTwoEndsOfASquareAreSampsonsOfItsArea) {
  // A square of 100 um at 1 uL/min: 3 eta Q/R^3 with pi R^2 = (100 um)^2.
  const auto terms =
      passage_terms(kWater, 1e-3 * mL_per_min, {1.0 * mm, 100.0 * um, 100.0 * um}, kReservoirs);
  const double by_hand =
      3.0 * 1e-3 * (1e-9 / 60.0) / std::pow(100e-6 / std::sqrt(std::numbers::pi), 3);
  EXPECT_NEAR((drop(terms, "step at the entry") + drop(terms, "step at the exit")) / by_hand, 1.0,
              1e-12);
}

/// Between sections that are 1/ratio times as large as the passage's.
std::vector<PressureTerm> between_sections(double ratio) {
  PassageFittings ends;
  ends.from = ends.into = (1.0 / ratio) * (kPassage.width * kPassage.height);
  return passage_terms(kWater, kFlow, kPassage, ends);
}

TEST(PassageTerms, OfAStepThatIsNoneCostNothing) {
  // An area is rounded to 1e-16, what hangs on it with it.
  for (const PressureTerm& term : between_sections(1.0 - 1e-15)) {
    if (term.name == "duct") continue;
    EXPECT_NEAR(term.drop.si(), 0.0, 1e-9) << term.name;
    EXPECT_NEAR(term.uncertainty.si(), 0.0, 1e-9) << term.name;
  }
}

TEST(PassageTerms, OfAStepGrowWithItUpToThoseOfAReservoir) {
  const auto all = passage_terms(kWater, kFlow, kPassage, kReservoirs);
  for (const char* name : {"contraction", "development", "step at the entry", "step at the exit"}) {
    double last = 0.0;
    for (const double ratio : {0.999, 0.9, 0.5, 0.1, 0.001}) {
      const double now = drop(between_sections(ratio), name);
      EXPECT_GT(now, last) << name << " at " << ratio;
      last = now;
    }
    EXPECT_LT(last, drop(all, name));
    EXPECT_NEAR(last / drop(all, name), 1.0, 1.1e-3) << name;  // 1 - ratio
  }
}

TEST(PassageTerms, OfAStepHaveBarsThatHoldOtherWeights) {
  // The half width of the weight is ratio (1 - ratio): to (1 - ratio)^2 and to 1 - ratio^2.
  const auto all = passage_terms(kWater, kFlow, kPassage, kReservoirs);
  for (const double ratio : {0.1, 0.5, 0.9}) {
    const auto terms = between_sections(ratio);
    for (std::size_t i = 0; i < terms.size(); ++i) {
      if (terms[i].formula != "development" && terms[i].formula != "steps") continue;
      const double half_width = std::sqrt(3.0) * terms[i].uncertainty.si();
      EXPECT_GE(half_width, ratio * (1.0 - ratio) * all[i].drop.si()) << terms[i].name;
    }
  }
}

TEST(PassageTerms, FollowFlowRateAndViscosityAsTheySay) {
  // Differences of whole drops against the parts' own derivatives; central, 1e-6 by the square.
  PassageFittings fittings;
  fittings.from_reservoir = true;
  fittings.into = 3.0 * (kPassage.width * kPassage.height);
  fittings.round_bends = fittings.mitre_bends = 1;
  constexpr double kStep = 1e-3;
  const auto at = [&](double by_viscosity, double by_flow_rate) {
    return passage_terms({by_viscosity * kWater.viscosity, kWater.density}, by_flow_rate * kFlow,
                         kPassage, fittings);
  };
  const auto terms = at(1.0, 1.0);
  ASSERT_EQ(terms.size(), 8U);
  for (std::size_t i = 0; i < terms.size(); ++i) {
    const double tolerance = 1e-5 * std::abs(terms[i].drop.si()) + 1e-9;
    EXPECT_NEAR((at(1.0 + kStep, 1.0)[i].drop - at(1.0 - kStep, 1.0)[i].drop).si() / (2.0 * kStep),
                terms[i].by_viscosity.si(), tolerance)
        << terms[i].name;
    EXPECT_NEAR((at(1.0, 1.0 + kStep)[i].drop - at(1.0, 1.0 - kStep)[i].drop).si() / (2.0 * kStep),
                terms[i].by_flow_rate.si(), tolerance)
        << terms[i].name;
  }
}

TEST(PassageTerms, FollowTheHeightOfThePassage) {
  RigidPassage passage = kPassage;
  passage.height_uncertainty = 1.75 * um;  // 1 %
  const auto terms = passage_terms(kWater, kFlow, passage, kReservoirs);
  // w h^3 (1 - 0.63 h/w): -3 and 0.07 more; the difference errs by some 1e-4.
  EXPECT_NEAR(terms[0].height_effect / terms[0].drop, -0.03 + 0.01 * 0.0694, 1e-4);
  EXPECT_NEAR(terms[1].height_effect / terms[1].drop, -0.02, 1e-5);  // rho U^2/2
  EXPECT_EQ(passage_terms(kWater, kFlow, kPassage, kReservoirs)[0].height_effect, Pressure{});
  passage.height_uncertainty = passage.height;
  EXPECT_THROW(passage_terms(kWater, kFlow, passage, {}), InputError);
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

}  // namespace
}  // namespace manoscope::flow
