// What gap, viscosity and flow rate do to QR and to the verdict.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "manoscope/core/random.hpp"
#include "manoscope/validation/drop_agreement.hpp"
#include "manoscope/validation/test_trial.hpp"

namespace manoscope::validation {
namespace {

constexpr FlowRate kFlowRate = 40.0 * mL_per_min;

struct Case {
  Trial trial;
  Profile state = trial.state();
  PressureReading reading = trial.reading(state);

  DropAgreement agree(const FlowUncertainty& uncertainty, FlowRate flow_rate = kFlowRate) const {
    return compare(reading, state, flow_rate, kChannel, uncertainty);
  }
};

double effect(const Estimate& estimate, const std::string& variable) {
  double sum = 0.0;
  for (const Estimate::Term& term : estimate.terms) {
    if (term.variable == variable) sum += term.effect;
  }
  return sum;
}

TEST(FlowUncertainty, AddsToThatOfTheMapsAsTheFormulaSays) {
  const Case test;
  const DropAgreement exact = test.agree({});
  const double qr = exact.resistance.value, maps = exact.resistance.standard_uncertainty();
  ASSERT_GT(maps, 0.0);
  // 0.02 of 1.0 mPa s and 1.5 %: by hand, u^2 = maps^2 + QR^2 (0.02^2 + 0.015^2).
  const DropAgreement found = test.agree({Length{}, 0.02 * mPa_s, 0.015});
  EXPECT_EQ(found.resistance.value, qr);
  EXPECT_NEAR(found.resistance.standard_uncertainty(),
              std::sqrt(maps * maps + qr * qr * (0.02 * 0.02 + 0.015 * 0.015)), 1e-10 * qr);
  EXPECT_NEAR(effect(found.resistance, "viscosity"), 0.02 * qr, 1e-12 * qr);
  EXPECT_NEAR(effect(found.resistance, "flow rate"), 0.015 * qr, 1e-12 * qr);
  // The reading knows neither.
  EXPECT_EQ(found.extracted.standard_uncertainty(), exact.extracted.standard_uncertainty());
  EXPECT_EQ(effect(found.extracted, "viscosity"), 0.0);
  EXPECT_EQ(effect(found.extracted, "flow rate"), 0.0);
}

TEST(FlowUncertainty, EntersTheVerdictByHand) {
  const Case test;
  const DropAgreement exact = test.agree({});
  const double difference = std::abs(exact.extracted.value - exact.resistance.value);
  const double variance = std::pow(difference / (2.0 * exact.en_number), 2);  // E_n has k = 2
  const double qr = exact.resistance.value;
  const DropAgreement found = test.agree({Length{}, 0.03 * mPa_s, 0.04});
  // Independent of all else: 3 % and 4 % of QR are 5 % of it.
  const double expanded = 2.0 * std::sqrt(variance + std::pow(0.05 * qr, 2));
  EXPECT_NEAR(found.en_number, difference / expanded, 1e-9 * found.en_number);
  EXPECT_LT(found.en_number, exact.en_number);
}

TEST(FlowUncertainty, IsOneErrorOfAllRuns) {
  const Case test;
  const FlowUncertainty uncertainty{0.5 * um, 0.02 * mPa_s, 0.015};
  const DropAgreement slow = test.agree(uncertainty, 10.0 * mL_per_min);
  const DropAgreement fast = test.agree(uncertainty);
  for (const char* variable : {"channel height", "viscosity", "flow rate"}) {
    // Effects in proportion to the drop: fully correlated. QR is linear in Q; round-off.
    EXPECT_NEAR(effect(fast.resistance, variable) / effect(slow.resistance, variable), 4.0, 1e-9);
  }
}

TEST(FlowUncertainty, IsTheSpreadOfQRWhenPumpAndFluidAreDrawn) {
  const Case test;
  const FlowUncertainty uncertainty{Length{}, 0.02 * mPa_s, 0.015};
  const DropAgreement truth = test.agree(uncertainty);
  double squares = 0.0;
  constexpr int kTrials = 4000;
  for (int i = 0; i < kTrials; ++i) {
    RandomStream stream(static_cast<std::uint64_t>(i), "pump and fluid");
    const flow::Fluid fluid{(1.0 + 0.02 * stream.normal()) * mPa_s, kWater.density};
    const FlowRate flow_rate = (1.0 + 0.015 * stream.normal()) * kFlowRate;
    const auto found =
        compare_drops(kChannel, fluid, flow_rate, uncertainty, test.state, test.reading, kSection);
    squares += std::pow(found.resistance.value - truth.resistance.value, 2);
  }
  // Stated without the part of the maps, which stay the same here; the product of two errors adds
  // 1e-4. Sampling error of a width from 4000 draws is 1.1 %: four of it.
  const double stated =
      std::hypot(effect(truth.resistance, "viscosity"), effect(truth.resistance, "flow rate"));
  EXPECT_NEAR(std::sqrt(squares / kTrials) / stated, 1.0, 0.045);
}

}  // namespace
}  // namespace manoscope::validation
