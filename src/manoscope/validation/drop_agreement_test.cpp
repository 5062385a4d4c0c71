#include "manoscope/validation/drop_agreement.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>

#include "manoscope/core/error.hpp"
#include "manoscope/core/flags.hpp"
#include "manoscope/validation/test_trial.hpp"

namespace manoscope::validation {
namespace {

/// Sum of the effects of one variable.
double effect(const Estimate& estimate, const std::string& variable) {
  double sum = 0.0;
  for (const Estimate::Term& term : estimate.terms) {
    if (term.variable == variable) sum += term.effect;
  }
  return sum;
}

/// Flow rate at which a wall without errors resists with exactly its own drop.
FlowRate matching_flow_rate(const Trial& exact, const flow::Channel& channel) {
  const Profile state = exact.state();
  const DropAgreement at_one = compare(exact.reading(state), state, 1.0 * mL_per_min, channel);
  return at_one.extracted.value / at_one.resistance.value * mL_per_min;
}

TEST(CompareDrops, GivesBothDropsOfAKnownChannel) {
  const Trial exact;
  const Profile state = exact.state();
  const auto found = compare(exact.reading(state), state, 40.0 * mL_per_min);
  const double x1 = exact.x[kSection.first], x2 = exact.x[kSection.last];
  // The reading interpolates between 16 levels of an exact wall: well below 1e-3.
  EXPECT_NEAR(found.extracted.value / (exact.truth(x1) - exact.truth(x2)), 1.0, 1e-3);
  double by_hand = 0.0;  // Simpson's rule on the true wall
  constexpr int kSteps = 2000;
  for (int i = 0; i <= kSteps; ++i) {
    const double at = x1 + (x2 - x1) * i / kSteps;
    const double weight = i == 0 || i == kSteps ? 1.0 : (i % 2 == 1 ? 4.0 : 2.0);
    by_hand += weight * resistance_by_hand(175e-6 + exact.wall.zeta(at, exact.truth(at))) / 3.0;
  }
  by_hand *= 40e-6 / 60.0 * (x2 - x1) / kSteps;
  // Trapezoid on stations 0.6 mm apart: step^2/12 [r'] / mean r, about 3e-4.
  EXPECT_NEAR(found.resistance.value / by_hand, 1.0, 1e-3);
}

/// Every effect of the flow map's errors against re-reading and re-integrating a shifted profile.
void expect_effects_of_the_flow_map(const Trial& trial, const Profile& state) {
  const FlowRate flow_rate = 40.0 * mL_per_min;
  const auto curves = trial.curves();
  const GaugeErrors gauge{trial.gain, Pressure::from_si(trial.zero)};
  const auto at = [&](const Array1& shape, double size) {
    Profile moved = state;
    moved.zeta += size * shape;
    return compare(inversion::read_pressure(curves, moved, gauge), moved, flow_rate);
  };
  const auto found = compare(inversion::read_pressure(curves, state, gauge), state, flow_rate);
  const auto check = [&](const std::string& variable, const Array1& shape) {
    constexpr double kSize = 0.1;  // of a standard deviation; the rest of third order
    const DropAgreement up = at(shape, kSize), down = at(shape, -kSize);
    const double extracted = (up.extracted.value - down.extracted.value) / (2.0 * kSize);
    const double resistance = (up.resistance.value - down.resistance.value) / (2.0 * kSize);
    // 1e-12 of round-off of 1e4 Pa over steps of 0.1, and curvature 1e-6.
    const double slack = 1e-7;
    EXPECT_NEAR(effect(found.extracted, variable), extracted, slack + 1e-5 * std::abs(extracted))
        << variable;
    EXPECT_NEAR(effect(found.resistance, variable), resistance, slack + 1e-5 * std::abs(resistance))
        << variable;
  };
  for (const ErrorMode& mode : state.uncertainty.modes) check(mode.variable, mode.effect);
  for (Index ix = 0; ix < kStations; ++ix) {
    Array1 alone = Array1::Zero(kStations);
    alone[ix] = state.uncertainty.independent[ix];
    check("noise of the flow profile at station " + std::to_string(ix), alone);
  }
}

TEST(CompareDrops, EffectsOfTheFlowMapAreItsDerivatives) {
  const Trial trial;
  expect_effects_of_the_flow_map(trial, trial.state());
}

TEST(CompareDrops, StationsWithoutDataInsideTakeNoPart) {
  const Trial trial;
  Profile state = trial.state();
  for (const Index ix : {6, 7, 12}) {
    state.flags[ix] = StationFlag::no_data;
    state.zeta[ix] = 0.0;
    state.uncertainty.independent[ix] = 0.0;
  }
  expect_effects_of_the_flow_map(trial, state);
  const auto with_hole = compare(trial.reading(state), state, 40.0 * mL_per_min);
  Profile rubbish = state;
  for (const Index ix : {6, 7, 12}) rubbish.zeta[ix] = -174e-6;
  const auto other = compare(trial.reading(rubbish), rubbish, 40.0 * mL_per_min);
  EXPECT_EQ(with_hole.resistance.value, other.resistance.value);
  EXPECT_EQ(with_hole.en_number, other.en_number);
  // Three straight bridges over a smooth wall: a hole of 3 steps errs as the trapezoid rule does.
  const Profile whole = trial.state();
  const auto without_hole = compare(trial.reading(whole), whole, 40.0 * mL_per_min);
  EXPECT_NEAR(with_hole.resistance.value / without_hole.resistance.value, 1.0, 1e-3);
  EXPECT_EQ(with_hole.extracted.value, without_hole.extracted.value);
}

TEST(CompareDrops, GapIsInTheResistanceAlone) {
  const Trial trial;
  const Profile state = trial.state();
  const PressureReading reading = trial.reading(state);
  const auto at = [&](Length height) {
    return compare(reading, state, 40.0 * mL_per_min, {15.5 * mm, 1.7 * mm, height});
  };
  const auto found = at(175.0 * um), up = at(175.1 * um), down = at(174.9 * um);
  const double slope = (up.resistance.value - down.resistance.value) / 0.2e-6;
  // Third order: 10 (step/gap)^2 = 3e-6.
  EXPECT_NEAR(effect(found.resistance, "channel height") / (slope * 0.5e-6), 1.0, 1e-5);
  EXPECT_EQ(effect(found.extracted, "channel height"), 0.0);
  EXPECT_EQ(up.extracted.value, found.extracted.value);
  EXPECT_EQ(up.extracted.standard_uncertainty(), found.extracted.standard_uncertainty());
}

TEST(CompareDrops, SharesOnlyTheErrorsOfTheFlowMap) {
  Trial trial;
  trial.gain = 0.002;
  trial.zero = 5.0;
  const Profile state = trial.state();
  const auto found = compare(trial.reading(state), state, 40.0 * mL_per_min);
  std::set<std::string> in_extracted, shared;
  for (const auto& term : found.extracted.terms) in_extracted.insert(term.variable);
  for (const auto& term : found.resistance.terms) {
    if (in_extracted.contains(term.variable)) shared.insert(term.variable);
  }
  const std::set<std::string> expected{"level plane, offset, flow", "level plane, tilt, flow",
                                       "shift of flow", "noise of the flow profile at station 3",
                                       "noise of the flow profile at station 21"};
  EXPECT_EQ(shared, expected);
  for (const char* alone : {"label of h5", "gauge gain", "gauge zero"}) {
    EXPECT_TRUE(in_extracted.contains(alone)) << alone;
  }
}

TEST(CompareDrops, DropUncertaintyIsThatOfTheCovarianceOfThePressures) {
  Trial trial;
  trial.gain = 0.002;
  trial.zero = 5.0;
  trial.seed = 4;
  const Profile state = trial.state();
  const PressureReading reading = trial.reading(state);
  const Matrix c = reading.uncertainty.covariance();
  const Index a = kSection.first, b = kSection.last;
  const auto found = compare(reading, state, 40.0 * mL_per_min);
  EXPECT_NEAR(found.extracted.standard_uncertainty() / std::sqrt(c(a, a) + c(b, b) - 2.0 * c(a, b)),
              1.0, 1e-12);
}

struct Spread {
  double n = 0.0, sum = 0.0, squares = 0.0;
  void add(double pull) {
    n += 1.0;
    sum += pull;
    squares += pull * pull;
  }
  double mean() const { return sum / n; }
  double width() const { return std::sqrt(squares / n); }
};

struct MonteCarlo {
  Spread extracted, resistance, difference;
  double agreeing = 0.0;
  double uncorrelated_ratio = 0.0;  ///< u of the difference if nothing were shared, over the stated
};

/// Whole experiments with every error drawn anew; pulls about the exact drops, which agree.
MonteCarlo run_trials(Trial trial, int n_trials, const flow::Channel& channel = kChannel,
                      Length height_uncertainty = kHeightUncertainty) {
  const Trial exact;
  const FlowRate flow_rate = matching_flow_rate(exact, channel);
  const Profile exact_state = exact.state();
  const auto truth = compare(exact.reading(exact_state), exact_state, flow_rate, channel);
  MonteCarlo result;
  for (int i = 1; i <= n_trials; ++i) {
    trial.seed = static_cast<std::uint64_t>(i);
    const Profile state = trial.state();
    flow::Channel stated = channel;
    stated.height += RandomStream(trial.seed, "height").normal() * height_uncertainty;
    const auto found =
        compare(trial.reading(state), state, flow_rate, stated, {height_uncertainty});
    const double u_extracted = found.extracted.standard_uncertainty();
    const double u_resistance = found.resistance.standard_uncertainty();
    const double difference = found.extracted.value - found.resistance.value;
    const double u_difference = std::abs(difference) / (2.0 * found.en_number);
    result.extracted.add((found.extracted.value - truth.extracted.value) / u_extracted);
    result.resistance.add((found.resistance.value - truth.resistance.value) / u_resistance);
    result.difference.add(difference / u_difference);
    result.agreeing += (found.en_number <= 1.0 ? 1.0 : 0.0) / n_trials;
    result.uncorrelated_ratio += std::hypot(u_extracted, u_resistance) / u_difference / n_trials;
  }
  return result;
}

constexpr int kTrials = 800;
// Sampling error of a width from 800 draws is 2.5 %, of a mean 3.5 %: four of each.
constexpr double kWidthSlack = 0.10, kMeanSlack = 0.14;
// P(|pull| < 2) = 0.9545 +- 0.0074: four of these.
constexpr double kAgreeing = 0.9545, kAgreeingSlack = 0.030;

TEST(CompareDrops, StatedVariancesAreThoseOfManyExperiments) {
  Trial trial;
  trial.level_errors = trial.flow_errors = {5e-9, 5e-9, 5e-9, 5e-6};
  trial.gain = 0.003;
  trial.zero = 8.0;
  const MonteCarlo found = run_trials(trial, kTrials);
  for (const Spread& spread : {found.extracted, found.resistance, found.difference}) {
    EXPECT_NEAR(spread.mean(), 0.0, kMeanSlack);
    EXPECT_NEAR(spread.width(), 1.0, kWidthSlack);
  }
  EXPECT_NEAR(found.agreeing, kAgreeing, kAgreeingSlack);
}

TEST(CompareDrops, SharedErrorsOfTheFlowMapWidenTheDifference) {
  // An outward error of the flow map raises dp_e and lowers QR: the difference feels both, most of
  // all over a low gap.
  Trial trial;
  trial.level_errors = {1e-9, 1e-9, 1e-9, 0.1e-6};
  trial.flow_errors = {1e-9, 60e-9, 1e-9, 0.1e-6};
  trial.label = 1.0;
  const MonteCarlo found = run_trials(trial, kTrials, {15.5 * mm, 1.7 * mm, 60.0 * um}, 0.02 * um);
  EXPECT_LT(found.uncorrelated_ratio, 0.9);  // else this experiment could not tell
  EXPECT_NEAR(found.difference.width(), 1.0, kWidthSlack);
  EXPECT_NEAR(found.difference.mean(), 0.0, kMeanSlack);
}

TEST(CompareDrops, WithoutAnyUncertaintyHasNoVerdict) {
  Trial exact;
  exact.level_errors = exact.flow_errors = {0.0, 0.0, 0.0, 0.0};
  exact.label = 0.0;
  const Profile state = exact.state();
  const auto found =
      compare_drops(kChannel, kWater, 10.0 * mL_per_min, {}, state, exact.reading(state), kSection);
  // What is left is the doubt of interpolation alone; without it too there is no number.
  EXPECT_GT(std::abs(found.extracted.value - found.resistance.value), 1e3);
  EXPECT_GT(found.en_number, 1.0);
  PressureReading certain = exact.reading(state);
  certain.uncertainty.modes.clear();
  const auto verdict =
      compare_drops(kChannel, kWater, 10.0 * mL_per_min, {}, state, certain, kSection);
  EXPECT_TRUE(std::isnan(verdict.en_number)) << verdict.en_number;
}

TEST(CompareDrops, RefusesAWallThatTouchesTheFloor) {
  const Trial trial;
  Profile state = trial.state();
  const PressureReading reading = trial.reading(state);
  state.zeta[10] = -176e-6;
  EXPECT_THROW(compare(reading, state, 10.0 * mL_per_min), InputError);
}

}  // namespace
}  // namespace manoscope::validation
