#include "manoscope/validation/compare_models.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "manoscope/core/error.hpp"
#include "manoscope/validation/test_coupled_trial.hpp"

namespace manoscope::validation {
namespace {

using flow::FlowModel;

const ModelAgreement& of(const ModelComparison& comparison, FlowModel model) {
  for (const ModelAgreement& found : comparison.models) {
    if (found.model == model) return found;
  }
  throw std::out_of_range("model");
}

TEST(CompareModels, GivesTheDropAndBarsOfCompareDropsForThePaper) {
  CoupledTrial trial;
  trial.seed = 2;
  const Profile state = trial.state(trial.fine_pressure());
  const inversion::PressureReading reading = trial.reading(state);
  const FlowUncertainty uncertainty{kHeightUncertainty, 0.1 * mPa_s, 0.01};
  const DropAgreement before =
      compare_drops(kChannel, kOil, kOilFlow, uncertainty, state, reading, kSection);
  const ModelComparison now = compare_models(observed(kChannel, kOil, uncertainty), kOilFlow, state,
                                             reading, kSection, {FlowModel::paper});
  EXPECT_DOUBLE_EQ(now.extracted.value, before.extracted.value);
  EXPECT_NEAR(now.extracted.standard_uncertainty() / before.extracted.standard_uncertainty(), 1.0,
              1e-12);
  const Estimate& drop = of(now, FlowModel::paper).drop;
  EXPECT_NEAR(drop.value / before.resistance.value, 1.0, 1e-12);
  // The stated error of the model comes on top; derivatives by differences: 1e-3.
  double squares = 0.0;
  for (const Estimate::Term& term : drop.terms) {
    if (term.source != "flow model") squares += term.effect * term.effect;
  }
  EXPECT_NEAR(std::sqrt(squares) / before.resistance.standard_uncertainty(), 1.0, 2e-3);
}

TEST(CompareModels, RaisesFewFalseAlarmsAndCatchesAGapThatIsWrongByThreePerCent) {
  // Stated: gap 0.5 um (0.29 % of 2 h0), viscosity 0.3 %, pump 0.3 %. Drawn with these widths.
  const FlowUncertainty stated{kHeightUncertainty, 0.003 * kOil.viscosity, 0.003};
  const FlowSetup setup = observed(kChannel, kOil, stated);
  constexpr int kSeeds = 500;
  int alarms = 0, caught_high = 0, caught_low = 0, along = 0;
  double squares = 0.0;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    CoupledTrial trial;
    trial.seed = static_cast<std::uint64_t>(seed) + 1000;
    trial.gain = 1e-3;
    trial.zero = 5.0;
    RandomStream truth(trial.seed, "truth");
    trial.channel.height = kChannel.height + truth.normal() * kHeightUncertainty;
    trial.fluid.viscosity = kOil.viscosity + truth.normal() * stated.viscosity;
    trial.flow_rate = (1.0 + 0.003 * truth.normal()) * kOilFlow;
    const Profile state = trial.state(trial.fine_pressure());
    const inversion::PressureReading reading = trial.reading(state);
    const auto verdict = [&](const FlowSetup& with) {
      const ModelComparison found =
          compare_models(with, kOilFlow, state, reading, kSection, {FlowModel::creeping});
      return found.models.front();
    };
    const ModelAgreement fair = verdict(setup);
    alarms += fair.agreement != Agreement::agree;
    along += fair.along.tail < 0.01;
    squares += std::pow(fair.difference / fair.uncertainty, 2);
    // The observer's gap is wrong by 3 %, ten times what he states.
    static const FlowSetup high = observed({15.5 * mm, 1.7 * mm, 1.03 * 175.0 * um}, kOil, stated);
    static const FlowSetup low = observed({15.5 * mm, 1.7 * mm, 0.97 * 175.0 * um}, kOil, stated);
    caught_high += verdict(high).agreement == Agreement::differ;
    caught_low += verdict(low).agreement == Agreement::differ;
  }
  EXPECT_LE(alarms, 0.05 * kSeeds);
  EXPECT_GE(caught_high, 0.9 * kSeeds);
  EXPECT_GE(caught_low, 0.9 * kSeeds);
  EXPECT_LE(along, 0.04 * kSeeds);  // 1 % +- 0.45 %: more than six sigma
  EXPECT_NEAR(std::sqrt(squares / kSeeds), 1.0,
              0.15);  // four sigma of 1/sqrt(1000)
  std::printf("verdicts: %d false alarms, caught %d and %d of %d, along x %d, pulls rms %.2f\n",
              alarms, caught_high, caught_low, kSeeds, along, std::sqrt(squares / kSeeds));
}

TEST(CompareModels, GivesNoVerdictWithoutAStatedGap) {
  CoupledTrial trial;
  trial.seed = 1;
  const Profile state = trial.state(trial.fine_pressure());
  const ModelComparison found =
      compare_models(observed(kChannel, kOil, {}), kOilFlow, state, trial.reading(state), kSection,
                     {FlowModel::paper, FlowModel::creeping});
  for (const ModelAgreement& model : found.models) {
    EXPECT_EQ(model.agreement, Agreement::no_verdict);
    EXPECT_EQ(model.words, "no verdict: the gap has no stated uncertainty");
    EXPECT_TRUE(std::isnan(model.en_number));
    EXPECT_GT(model.drop.value, 0.0);  // the numbers are there all the same
  }
}

/// Water at 40 mL/min, Re h/l = 4.5, with the gain of momentum of developed profiles.
struct FastRun {
  CoupledTrial trial;
  Profile state;
  inversion::PressureReading reading;
  FastRun() {
    trial.seed = 4;
    trial.fluid = kWater;
    trial.flow_rate = 40.0 * mL_per_min;
    trial.inertia = true;
    trial.x = trial.wall.stations(kStations);
    state = trial.state(trial.fine_pressure());
    reading = trial.reading(state);
  }
};

TEST(CompareModels, SplitsTheDropIntoCorrectionsThatAddUp) {
  const FastRun run;
  const FlowSetup setup = observed(kChannel, kWater);
  const ModelComparison found =
      compare_models(setup, run.trial.flow_rate, run.state, run.reading, kSection, all_models());
  ASSERT_EQ(found.models.size(), 7U);
  ASSERT_EQ(found.corrections.size(), 5U);
  double sum = 0.0;
  for (const Correction& term : found.corrections) sum += term.section.si();
  EXPECT_NEAR(sum / of(found, FlowModel::section_march).drop.value, 1.0, 1e-12);  // telescopes
  // The section is a rectangle: nothing to correct but eq. (4) against the series, 8e-5.
  EXPECT_LT(std::abs(found.corrections[1].section / found.corrections[0].section), 1e-4);
  // The gap closes downstream, the fluid gains speed: inertia takes pressure there.
  EXPECT_GT(found.corrections[2].section.si(), 0.0);
  EXPECT_EQ(found.corrections[3].section, Pressure{});  // developed inlet: no entry
  EXPECT_EQ(found.corrections[3].spread, Pressure{});   // and known to be so
  for (const int k : {0, 1, 2, 4}) {
    EXPECT_FALSE(found.corrections[static_cast<std::size_t>(k)].spread);  // none is formed
  }
}

TEST(CompareModels, CallsTheModelTrueThatIsAndTellsThatCreepingFlowIsNotValid) {
  const FastRun run;
  const ModelComparison found =
      compare_models(observed(kChannel, kWater), run.trial.flow_rate, run.state, run.reading,
                     kSection, {FlowModel::creeping, FlowModel::momentum});
  EXPECT_EQ(of(found, FlowModel::momentum).agreement, Agreement::agree)
      << of(found, FlowModel::momentum).words;
  EXPECT_LT(std::abs(of(found, FlowModel::momentum).difference),
            std::abs(of(found, FlowModel::creeping).difference));
  EXPECT_FALSE(of(found, FlowModel::creeping).valid);
  EXPECT_NE(of(found, FlowModel::creeping).words.find("the model itself may be"),
            std::string::npos);
  // Re_x = 2Q/(nu(w + h)) by hand at the clamped outlet: 2*6.667e-7/(1.002e-6*1.875e-3) = 709.7.
  EXPECT_NEAR(found.reynolds[found.reynolds.size() - 1],
              2.0 * 40e-6 / 60.0 / (1e-3 / 998.0 * 1.875e-3), 1e-9);
  EXPECT_TRUE(found.laminar);
  EXPECT_LT(found.relative_drag, 1.0);  // the wall bulges
}

TEST(CompareModels, CountsAnUnknownInletInEveryModel) {
  const FastRun run;
  FlowSetup known = observed(kChannel, kWater), unknown = known;
  unknown.inlet_spread = 1.0;
  const auto bar = [&](const FlowSetup& setup, FlowModel model) {
    return compare_models(setup, run.trial.flow_rate, run.state, run.reading, kSection, {model})
        .models.front()
        .uncertainty;
  };
  for (const FlowModel model : {FlowModel::momentum, FlowModel::plane_march}) {
    EXPECT_GT(bar(unknown, model), bar(known, model));
  }
}

TEST(CompareModels, LeavesOutMarchesAgainstTheFlow) {
  CoupledTrial trial;
  trial.seed = 1;
  trial.flow_rate = -kOilFlow;
  trial.outlet = 14.0 * kPa;
  const Profile state = trial.state(trial.fine_pressure());
  const ModelComparison found = compare_models(observed(kChannel, kOil), -kOilFlow, state,
                                               trial.reading(state), kSection, all_models());
  EXPECT_EQ(found.models.size(), 4U);
  EXPECT_EQ(found.corrections.size(), 3U);
  EXPECT_EQ(of(found, FlowModel::creeping).agreement, Agreement::agree)
      << of(found, FlowModel::creeping).words;
}

TEST(CompareModels, RefusesASectionThatEndsWithoutAPressure) {
  CoupledTrial trial;
  trial.seed = 1;
  const Profile state = trial.state(trial.fine_pressure());
  inversion::PressureReading reading = trial.reading(state);
  reading.flags[kSection.last] = ReadingFlag::no_data;
  EXPECT_THROW(compare_models(observed(kChannel, kOil), kOilFlow, state, reading, kSection,
                              {FlowModel::paper}),
               InputError);
}

}  // namespace
}  // namespace manoscope::validation
