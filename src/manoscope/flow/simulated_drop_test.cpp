#include "manoscope/flow/simulated_drop.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "manoscope/core/error.hpp"

namespace manoscope::flow {
namespace {

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

TEST(SimulatedDrop, TellsFrictionFromInertiaUnderTheFlowRate) {
  const std::vector<SimulatedDrop> two{{10.0 * mL_per_min, 430.0 * Pa, {}},
                                       {70.0 * mL_per_min, 4270.0 * Pa, {}}};  // 40 Q + 0.3 Q^2
  const PressureTerm term = simulated_drop(two, 50.0 * mL_per_min);
  EXPECT_NEAR(term.by_viscosity.si(), 2000.0, 1e-6);
  EXPECT_NEAR(term.by_flow_rate.si(), 2000.0 + 2.0 * 750.0, 1e-6);
}

TEST(SimulatedDrop, AloneCountsAsMuchAsItMay) {
  const PressureTerm term =
      simulated_drop({{20.0 * mL_per_min, 1.0 * kPa, 10.0 * Pa}}, 20.0 * mL_per_min);
  EXPECT_EQ(term.by_flow_rate, 2.0 * kPa);
  EXPECT_EQ(term.by_viscosity, 1.0 * kPa);
}

}  // namespace
}  // namespace manoscope::flow
