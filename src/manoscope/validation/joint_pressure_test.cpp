#include "manoscope/validation/joint_pressure.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "manoscope/validation/test_coupled_trial.hpp"

namespace manoscope::validation {
namespace {

TEST(JointPressure, IsNarrowerThanTheReadingAndCoversTheTruth) {
  // A noisy flow map: 60 nm a column is 100 to 200 Pa, where the flow model knows the fall to 1 %.
  const FlowUncertainty stated{kHeightUncertainty, 0.003 * kOil.viscosity, 0.003};
  const FlowSetup setup = observed(kChannel, kOil, stated);
  constexpr int kSeeds = 100;
  double squares = 0.0, before = 0.0, after = 0.0;
  int covered = 0, counted = 0;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    CoupledTrial trial;
    trial.seed = static_cast<std::uint64_t>(seed) + 300;
    trial.flow_errors.noise = 60e-9;
    RandomStream draw(trial.seed, "truth");
    trial.channel.height = kChannel.height + draw.normal() * kHeightUncertainty;
    trial.fluid.viscosity = kOil.viscosity + draw.normal() * stated.viscosity;
    trial.flow_rate = (1.0 + 0.003 * draw.normal()) * kOilFlow;
    const Array1 truth = trial.fine_pressure();
    const Profile state = trial.state(truth);
    const PressureReading reading = trial.reading(state);
    const PressureReading joint =
        joint_pressure(setup, flow::FlowModel::creeping, kOilFlow, state, reading, kSection);
    const Array1 u = joint.uncertainty.standard(), u_read = reading.uncertainty.standard();
    for (Index ix = kSection.first; ix <= kSection.last; ++ix) {
      EXPECT_LE(u[ix], u_read[ix] * (1.0 + 1e-9));
      const double error = joint.pressure[ix] - trial.at(truth, joint.x[ix]);
      squares += std::pow(error / u[ix], 2);
      covered += std::abs(error) <= kExpansion * u[ix];
      before += std::pow(reading.pressure[ix] - trial.at(truth, joint.x[ix]), 2);
      after += error * error;
      ++counted;
    }
  }
  EXPECT_LT(after, 0.9 * before);  // the error falls with the bars
  // 100 runs of some 10 independent numbers: rms 1 +- 0.03, and the curves' own bias of 0.2 %.
  EXPECT_NEAR(std::sqrt(squares / counted), 1.0, 0.12);
  EXPECT_GE(covered, 0.92 * counted);
  std::printf("joint: pulls rms %.2f, covered %.1f %%, rms error %.0f -> %.0f Pa\n",
              std::sqrt(squares / counted), 100.0 * covered / counted, std::sqrt(before / counted),
              std::sqrt(after / counted));
}

TEST(JointPressure, StaysTheReadingWhereTheModelKnowsNothing) {
  CoupledTrial trial;
  trial.seed = 9;
  const Profile state = trial.state(trial.fine_pressure());
  const PressureReading reading = trial.reading(state);
  // A pump known to a factor, a gap to half of it: nothing to learn but the shape.
  const FlowSetup setup = observed(kChannel, kOil, {90.0 * um, {}, 10.0});
  const PressureReading joint =
      joint_pressure(setup, flow::FlowModel::creeping, kOilFlow, state, reading, kSection);
  const Array1 moved = (joint.pressure - reading.pressure).abs();
  EXPECT_LT((moved / reading.uncertainty.standard().max(1e-9)).maxCoeff(), 2.0);
  EXPECT_TRUE((joint.flags == reading.flags).all());
}

}  // namespace
}  // namespace manoscope::validation
