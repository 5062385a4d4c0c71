#include "manoscope/validation/error_table.hpp"

#include <gtest/gtest.h>

#include "manoscope/validation/test_coupled_trial.hpp"

namespace manoscope::validation {
namespace {

TEST(ErrorTable, AddsUpWhatCarriesTheSameName) {
  ErrorTable table(2);
  table.add("plane", "leveling", (Array1(2) << 3.0, 1.0).finished());
  table.add("noise", "pixel noise", (Array1(2) << 0.0, 2.0).finished());
  table.add("plane", "leveling", (Array1(2) << -3.0, 1.0).finished());
  table.add("nothing", "none", Array1::Zero(2));
  ASSERT_EQ(table.modes().size(), 2U);
  const Matrix covariance = table.covariance();
  EXPECT_EQ(covariance(0, 0), 0.0);        // cancelled
  EXPECT_EQ(covariance(1, 1), 4.0 + 4.0);  // added, and the noise beside it
  const Estimate sum = table.combine(7.0, Array1::Ones(2));
  EXPECT_EQ(sum.value, 7.0);
  EXPECT_DOUBLE_EQ(sum.standard_uncertainty(), std::sqrt(8.0));
}

TEST(ErrorTable, HoldsTheCovarianceOfAReading) {
  CoupledTrial trial;
  trial.seed = 1;
  const Profile state = trial.state(trial.fine_pressure());
  const PressureReading reading = trial.reading(state);
  ErrorTable table(kStations);
  add_reading(table, -1.0, Matrix::Identity(kStations, kStations), reading, state);
  const Matrix expected = reading.uncertainty.covariance();
  EXPECT_LT((table.covariance() - expected).norm(), 1e-12 * expected.norm());  // round-off
}

TEST(ErrorTable, SharesTheFlowMapBetweenReadingAndModel) {
  // zeta up: the reading rises, the modelled drop falls. The difference feels both.
  CoupledTrial trial;
  trial.seed = 1;
  const Profile state = trial.state(trial.fine_pressure());
  const PressureReading reading = trial.reading(state);
  const FlowSetup setup = observed(kChannel, kOil);
  const ModelledRun run =
      modelled_run(flow::FlowModel::creeping, setup, kOilFlow, wall_line(state, kChannel.length));
  Matrix at_first = Matrix::Zero(1, kStations);
  at_first(0, kSection.first) = 1.0;
  ErrorTable read(1), both(1);
  add_reading(read, 1.0, at_first, reading, state);
  add_reading(both, 1.0, at_first, reading, state);
  add_model(both, -1.0, at_first, run, setup, state);
  const auto offset = [](const ErrorTable& table) {
    for (const ErrorMode& mode : table.modes()) {
      if (mode.variable == "level plane, offset, flow") return mode.effect[0];
    }
    return 0.0;
  };
  EXPECT_GT(offset(read), 0.0);
  EXPECT_GT(offset(both), offset(read));
}

}  // namespace
}  // namespace manoscope::validation
