#include "manoscope/twin/coupled.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "manoscope/core/error.hpp"
#include "manoscope/flow/one_dimensional.hpp"
#include "manoscope/twin/scenario.hpp"

namespace manoscope::twin {
namespace {

CoupledFlow solve(const Scenario& scenario, FlowRate flow_rate, int steps = 2000) {
  return solve_coupled(scenario.channel, scenario.fluid, scenario.make_wall(), flow_rate,
                       scenario.outlet.pressure(flow_rate), {steps, true});
}

TEST(CoupledFlow, WithoutFlowHasOnePressureEverywhere) {
  const Scenario scenario = small_s1();
  const CoupledFlow flow =
      solve_coupled(scenario.channel, scenario.fluid, scenario.make_wall(), FlowRate{}, 2.3 * kPa);
  EXPECT_EQ(flow.pressure.values().minCoeff(), 2300.0);
  EXPECT_EQ(flow.pressure.values().maxCoeff(), 2300.0);
  const Array1 x = Array1::LinSpaced(2001, 0.0, scenario.channel.length.si());
  EXPECT_LT(
      (flow.deflection.values() - scenario.make_wall().deflection(x, 2.3 * kPa)).abs().maxCoeff(),
      1e-20);
}

TEST(CoupledFlow, SolvesTheSameProblemAsFixedPointIterationOfTheRigidModel) {
  const Scenario scenario = small_s1();
  const wall::TaperedMembrane wall = scenario.make_wall();
  const Array1 x = Array1::LinSpaced(8001, 0.0, scenario.channel.length.si());
  for (const FlowRate flow_rate : {5.0 * mL_per_min, 70.0 * mL_per_min}) {
    const Pressure outlet = scenario.outlet.pressure(flow_rate);
    Array1 p = Array1::Constant(x.size(), outlet.si());
    double change = 1.0;
    for (int i = 0; i < 200 && change > 1e-9; ++i) {
      const Array1 next = flow::one_dimensional_pressure(
          scenario.channel, scenario.fluid, flow_rate, x, wall.deflection(x, p), outlet);
      change = (next - p).abs().maxCoeff();
      p = next;
    }
    ASSERT_LT(change, 1e-9);
    const CoupledFlow flow = solve(scenario, flow_rate);
    const double drop = p(0) - outlet.si();
    // The trapezoid rule of the rigid model on 8000 intervals errs by step^2 (r'/r)/(12 l): 1e-6.
    EXPECT_LT((flow.pressure(x) - p).abs().maxCoeff(), 3e-6 * drop);
  }
}

TEST(CoupledFlow, ConvergesWithFourthOrderToItsStatedError) {
  Scenario scenario = small_s1();
  for (const FlowRate flow_rate : scenario.flow_rates) {
    const double exact = solve(scenario, flow_rate, 64000).inlet().si();
    const double drop = exact - scenario.outlet.pressure(flow_rate).si();
    EXPECT_LT(std::abs(solve(scenario, flow_rate).inlet().si() - exact), 1e-6 * drop);
  }
  // The order, where the wall has no sharp turn (a strong prestress, no preload).
  scenario.membrane.prestress = 300.0 * MPa;
  scenario.preload.load = Pressure{};
  const double exact = solve(scenario, 70.0 * mL_per_min, 64000).inlet().si();
  const double coarse = std::abs(solve(scenario, 70.0 * mL_per_min, 200).inlet().si() - exact);
  const double fine = std::abs(solve(scenario, 70.0 * mL_per_min, 400).inlet().si() - exact);
  EXPECT_NEAR(std::log2(coarse / fine), 4.0, 0.3);
}

TEST(CoupledFlow, DropsMorePressureForMoreFlowButLessThanInProportion) {
  const Scenario scenario = small_s1();
  double last_drop = 0.0, last_resistance = 1e300;
  for (double q = 5.0; q <= 70.0; q += 5.0) {
    const CoupledFlow flow = solve(scenario, q * mL_per_min);
    const double drop = (flow.inlet() - flow.outlet()).si();
    EXPECT_GT(drop, last_drop);
    EXPECT_LT(drop / q, last_resistance);  // the wall bulges and the channel opens
    last_drop = drop;
    last_resistance = drop / q;
    const Array1& p = flow.pressure.values();
    EXPECT_GT((p.head(p.size() - 1) - p.tail(p.size() - 1)).minCoeff(), 0.0);
  }
}

TEST(CoupledFlow, ThroughAStiffWallIsPoiseuilleFlow) {
  Scenario scenario = small_s1();
  scenario.membrane.thickness = Length::from_si(1.0);
  scenario.membrane.prestress = 1.0 * GPa;
  const CoupledFlow flow = solve(scenario, 20.0 * mL_per_min);
  const double r = flow::duct_resistance(scenario.fluid.viscosity, scenario.channel.width,
                                         scenario.channel.height, flow::DuctFormula::series);
  const double drop = 20e-6 / 60.0 * r * scenario.channel.length.si();
  // 2 s0 t/a^2 = 2.8e15 Pa/m: the wall gives by 2 pm of 175 um, three times that in r.
  EXPECT_NEAR((flow.inlet() - flow.outlet()).si() / drop, 1.0, 1e-7);
}

TEST(CoupledFlow, SaysWhereTheWallTouchesTheFloor) {
  Scenario scenario = small_s1();
  scenario.channel.height = 8.0 * um;  // the preload bows the wall in by 11 um
  try {
    solve(scenario, FlowRate{});  // any flow would hold it open
    FAIL() << "a closed channel passed";
  } catch (const InputError& error) {
    EXPECT_NE(error.found().find("touches the floor at x = "), std::string::npos) << error.what();
  }
}

TEST(CoupledFlow, SaysWhenItsStepsAreTooFew) {
  Scenario scenario = small_s1();
  scenario.channel.height = 12.0 * um;  // nearly closed: the pressure climbs within micrometres
  try {
    solve(scenario, 0.001 * mL_per_min, 20);
    FAIL() << "an unresolved flow passed";
  } catch (const InputError& error) {
    EXPECT_NE(error.found().find("20 steps do not resolve"), std::string::npos) << error.what();
  }
}

TEST(CoupledFlow, RefusesAWallOfAnotherLengthAndTooFewSteps) {
  const Scenario scenario = small_s1();
  const wall::TaperedMembrane shorter(10.0 * mm, scenario.membrane);
  EXPECT_THROW(solve_coupled(scenario.channel, scenario.fluid, shorter, FlowRate{}, Pressure{}),
               InputError);
  EXPECT_THROW(solve(scenario, FlowRate{}, 5), InputError);
}

}  // namespace
}  // namespace manoscope::twin
