#include "manoscope/validation/infer_flow.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "manoscope/core/error.hpp"
#include "manoscope/validation/test_coupled_trial.hpp"

namespace manoscope::validation {
namespace {

/// A reading without any error, of a dense calibration.
CoupledTrial exact_trial() {
  CoupledTrial trial;
  trial.level_errors = trial.flow_errors = {0.0, 0.0, 0.0, 0.0};
  return trial;
}

TEST(InferFlowRate, RecoversTheFlowRateOfAnExactReading) {
  const CoupledTrial trial = exact_trial();
  const Profile state = trial.state(trial.fine_pressure());
  const InferredFlow found = infer_flow_rate(observed(kChannel, kOil), flow::FlowModel::creeping,
                                             state, trial.reading(state), kSection);
  // What is left: the curves between 16 levels (0.1 %), stations 0.6 mm apart (0.05 %).
  EXPECT_NEAR(found.value.value / kOilFlow.si(), 1.0, 2e-3);
  EXPECT_LE(found.steps, 10);
}

TEST(InferFlowRate, RecoversTheFlowRateWhereInertiaCounts) {
  CoupledTrial trial = exact_trial();
  trial.fluid = kWater;
  trial.flow_rate = 40.0 * mL_per_min;  // Re h/l = 4.5
  trial.inertia = true;
  const Profile state = trial.state(trial.fine_pressure());
  const inversion::PressureReading reading = trial.reading(state);
  const FlowSetup setup = observed(kChannel, kWater);
  const double momentum =
      infer_flow_rate(setup, flow::FlowModel::momentum, state, reading, kSection).value.value;
  EXPECT_NEAR(momentum / trial.flow_rate.si(), 1.0, 4e-3);  // as above, inertia more curved
  // The gap closes downstream and the fluid gains speed: without that, Q is off by per cents.
  const double creeping =
      infer_flow_rate(setup, flow::FlowModel::creeping, state, reading, kSection).value.value;
  EXPECT_GT(std::abs(creeping / trial.flow_rate.si() - 1.0), 0.01);
}

TEST(InferFlowRate, IsWithinTwoPerCentAndItsBarsCover95PerCent) {
  // Everything unknown is drawn with the width that is stated: maps, labels, gauge, the gap (0.3 %)
  // and the viscosity (0.5 %).
  const double viscosity_share = 0.005;
  const FlowSetup setup =
      observed(kChannel, kOil, {kHeightUncertainty, viscosity_share * kOil.viscosity, 0.0});
  constexpr int kSeeds = 200;
  int covered = 0, close = 0;
  double squares = 0.0, sum = 0.0, largest_bar = 0.0;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    CoupledTrial trial;
    trial.seed = static_cast<std::uint64_t>(seed);
    trial.gain = 1e-3;
    trial.zero = 5.0;
    RandomStream truth(trial.seed, "truth");
    trial.channel.height = kChannel.height + truth.normal() * kHeightUncertainty;
    trial.fluid.viscosity = (1.0 + viscosity_share * truth.normal()) * kOil.viscosity;
    const Profile state = trial.state(trial.fine_pressure());
    const InferredFlow found =
        infer_flow_rate(setup, flow::FlowModel::creeping, state, trial.reading(state), kSection);
    const double error = found.value.value / kOilFlow.si() - 1.0;
    const double pull = error / found.relative_uncertainty();
    covered += std::abs(pull) <= kExpansion;
    close += std::abs(error) <= 0.02;
    sum += pull;
    squares += pull * pull;
    largest_bar = std::max(largest_bar, found.relative_uncertainty());
  }
  // 200 draws: coverage 95.4 +- 1.5 %, mean 0 +- 0.07, width 1 +- 0.05; three sigma of each.
  EXPECT_GE(covered, 0.91 * kSeeds);
  EXPECT_NEAR(sum / kSeeds, 0.0, 0.21);
  EXPECT_NEAR(std::sqrt(squares / kSeeds), 1.0, 0.15);
  EXPECT_LT(2.0 * largest_bar, 0.024);  // gap 0.9 %, viscosity 0.5 %, maps: 1.1 %
  EXPECT_GE(close, 0.92 * kSeeds);      // 2 % is 1.8 of these sigma
  std::printf("Q: covered %d of %d, within 2 %%: %d, mean pull %.2f, rms %.2f, bar %.2f %%\n",
              covered, kSeeds, close, sum / kSeeds, std::sqrt(squares / kSeeds),
              largest_bar * 100.0);
}

TEST(InferFlowRate, GainsFromAllStationsOverTheTwoEnds) {
  CoupledTrial trial;
  trial.seed = 3;
  trial.flow_errors.noise = 40e-9;  // so that noise leads
  const Profile state = trial.state(trial.fine_pressure());
  const FlowSetup setup = observed(kChannel, kOil, {});
  const inversion::PressureReading reading = trial.reading(state);
  const InferredFlow all =
      infer_flow_rate(setup, flow::FlowModel::creeping, state, reading, kSection);
  const Array1 ends = (reading.x == reading.x[kSection.first]).cast<double>() -
                      (reading.x == reading.x[kSection.last]).cast<double>();
  const double drop = (ends * reading.pressure).sum();
  const double two_ends = std::sqrt(ends.square().matrix().dot(
                              (state.uncertainty.independent / reading.slope).square().matrix())) /
                          drop;
  EXPECT_LT(all.relative_uncertainty(), two_ends);
}

TEST(InferFlowRate, CountsTheGapThreefold) {
  const CoupledTrial trial = exact_trial();
  const Profile state = trial.state(trial.fine_pressure());
  const InferredFlow found =
      infer_flow_rate(observed(kChannel, kOil, {1.75 * um}), flow::FlowModel::creeping, state,
                      trial.reading(state), kSection);
  double by_gap = 0.0;
  for (const Estimate::Term& term : found.value.terms) {
    if (term.variable == "channel height") by_gap = term.effect / found.value.value;
  }
  // d ln Q/d ln(2 h0) = 3 (2h0)/h and a little for the sides, h = 175 + 7 .. 20 um: 2.7 to 2.9.
  EXPECT_NEAR(by_gap, 0.028, 0.0015);
}

TEST(InferViscosity, RecoversTheViscosityFromAKnownFlowRate) {
  const CoupledTrial trial = exact_trial();
  const Profile state = trial.state(trial.fine_pressure());
  flow::Fluid guess = kOil;
  guess.viscosity = 3.0 * mPa_s;
  const InferredFlow found =
      infer_viscosity(observed(kChannel, guess, {kHeightUncertainty, {}, 0.01}),
                      flow::FlowModel::creeping, kOilFlow, state, trial.reading(state), kSection);
  EXPECT_NEAR(found.value.value / kOil.viscosity.si(), 1.0, 2e-3);  // as for the flow rate
  EXPECT_GT(found.relative_uncertainty(), 0.01);                    // the pump's, and the gap's
}

TEST(InferFlowRate, RefusesAPressureThatRises) {
  const CoupledTrial trial = exact_trial();
  const Profile state = trial.state(trial.fine_pressure().reverse());
  EXPECT_THROW(infer_flow_rate(observed(kChannel, kOil), flow::FlowModel::creeping, state,
                               trial.reading(state), kSection),
               InputError);
}

TEST(InferFlowRate, SaysThatAWrongShapeOfPressureDoesNotFit) {
  CoupledTrial trial;
  trial.seed = 5;
  const Profile good = trial.state(trial.fine_pressure());
  const FlowSetup setup = observed(kChannel, kOil);
  EXPECT_GT(infer_flow_rate(setup, flow::FlowModel::creeping, good, trial.reading(good), kSection)
                .fit.tail,
            0.001);
  Array1 bent = trial.fine_pressure();  // as a narrow place half way would have it
  for (Index i = 0; i < CoupledTrial::kFine / 2; ++i) bent[i] += 600.0;
  const Profile bad = trial.state(bent);
  EXPECT_LT(
      infer_flow_rate(setup, flow::FlowModel::creeping, bad, trial.reading(bad), kSection).fit.tail,
      1e-6);
}

}  // namespace
}  // namespace manoscope::validation
