// Walls coupled to the flow models of flow::pressure_along().
#include "manoscope/twin/modelled_flow.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "manoscope/core/error.hpp"
#include "manoscope/twin/coupled.hpp"
#include "manoscope/twin/scenario.hpp"
#include "manoscope/twin/solved_scenario.hpp"

namespace manoscope::twin {
namespace {

using flow::FlowModel;

constexpr FlowRate kFast = 70.0 * mL_per_min;

/// A membrane in the manner of S1, taut: where one passes through flat it turns too sharply for a
/// flow with inertia.
Scenario membrane(const std::string& model) {
  Scenario scenario = small_s1();
  scenario.wall.prestress = 100.0 * MPa;
  scenario.wall.preload = {};
  scenario.solver = {};
  scenario.solver.flow_model = model;
  return scenario;
}

/// A short plate on few cells: 3 mm x 1.7 mm nitride over 100 um, 16 um high in the flow.
Scenario plate(const std::string& model) {
  Scenario scenario = membrane(model);
  scenario.wall_law = WallLaw::foppl_von_karman;
  scenario.channel.length = scenario.wall.length = 3.0 * mm;
  scenario.channel.height = 100.0 * um;
  scenario.wall.thickness = 1.0 * um;
  scenario.wall.prestress = 10.0 * MPa;
  scenario.wall_grid = {12, 4};
  scenario.outlet.head = 2.0 * kPa;
  scenario.solver.steps = 120;
  return scenario;
}

CoupledFlow solve(const Scenario& scenario, FlowRate flow_rate) {
  const WallModel wall = scenario.wall_model();
  const CoupledFlow rest =
      fill_channel(scenario.channel, wall, wall.rest(), Pressure{}, scenario.solver);
  return solve_coupled(scenario.channel, scenario.fluid, wall, rest, flow_rate,
                       scenario.outlet.pressure(flow_rate), scenario.solver);
}

double drop(const CoupledFlow& flow) { return (flow.inlet() - flow.outlet()).si(); }

/// What the model says of the wall that was found.
flow::ModelledPressure said_of(const CoupledFlow& found, const Scenario& scenario) {
  flow::FlowCase given;
  given.channel = scenario.channel;
  given.fluid = scenario.fluid;
  given.flow_rate = found.flow_rate;
  given.x = found.deflection.x();
  given.zeta = found.wall.deflection(given.x);
  given.shape = found.section;
  given.inlet = scenario.solver.inlet();
  given.outlet_pressure = scenario.outlet.pressure(found.flow_rate);
  return flow::pressure_along(*scenario.solver.model(), given);
}

std::string refusal(const Scenario& scenario, FlowRate flow_rate) {
  try {
    solve(scenario, flow_rate);
  } catch (const InputError& error) {
    return error.found();
  }
  return "a flow";
}

TEST(ModelledFlow, IsWhatItsModelSaysOfTheWallItLeaves) {
  for (const flow::FlowModelInfo& info : flow::kFlowModels) {
    for (const Scenario& scenario :
         {membrane(std::string(info.name)), plate(std::string(info.name))}) {
      for (const FlowRate flow_rate : {5.0 * mL_per_min, 30.0 * mL_per_min}) {
        const CoupledFlow found = solve(scenario, flow_rate);
        const flow::ModelledPressure said = said_of(found, scenario);
        // The residual that solve_coupled() states, and 1e-8 of the table of sections.
        EXPECT_LT((found.pressure.values() - said.pressure).abs().maxCoeff(), 1.01e-5 * drop(found))
            << info.name << " " << flow_rate.in(mL_per_min);
        EXPECT_EQ(said.flags.maxCoeff(), 0) << info.name;
        EXPECT_LT((found.deflection.values() - found.wall.deflection(found.deflection.x()))
                      .abs()
                      .maxCoeff(),
                  1e-20);
        // The wall stands under that pressure: nothing moves it any further.
        const WallModel wall = scenario.wall_model();  // loaded at the stations that it knows
        const Array1 x = Array1::LinSpaced(3841, 0.0, scenario.channel.length.si());
        const WallAtRest again = wall.load(found.wall, x, found.pressure(x));
        EXPECT_LT((again.deflection(x) - found.wall.deflection(x)).abs().maxCoeff(),
                  1e-5 * found.deflection.values().maxCoeff())
            << info.name;
      }
    }
  }
}

TEST(ModelledFlow, OfThePaperIsTheRectangleOfEquationFourWithoutInertia) {
  Scenario rectangle = membrane("rectangle");
  rectangle.solver.exact_duct = false;
  rectangle.solver.momentum_factor = 0.0;
  const auto difference = [&](int steps) {
    Scenario paper = rectangle;
    paper.solver = {};
    paper.solver.flow_model = "paper";
    paper.solver.steps = rectangle.solver.steps = steps;
    const CoupledFlow one = solve(paper, kFast), other = solve(rectangle, kFast);
    return (one.pressure.values() - other.pressure.values()).abs().maxCoeff() / drop(other);
  };
  // The trapezoid rule against cubics: second order. Two digits of the finer difference are above
  // the residual of 1e-5.
  const double coarse = difference(60), fine = difference(120);
  EXPECT_NEAR(std::log2(coarse / fine), 2.0, 0.3);
  EXPECT_LT(difference(240), 5e-5);
}

TEST(ModelledFlow, UnderAStiffWallIsThatOfARectangle) {
  Scenario scenario = membrane("rectangle");
  scenario.wall.thickness = Length::from_si(1.0);
  scenario.wall.prestress = 1.0 * GPa;
  const double exact = drop(solve(scenario, 20.0 * mL_per_min));
  for (const char* model : {"creeping", "momentum", "energy", "plane-march", "section-march"}) {
    scenario.solver.flow_model = model;
    // The resistance of the march on sections is within 1e-4.
    EXPECT_NEAR(drop(solve(scenario, 20.0 * mL_per_min)) / exact, 1.0, 1e-4) << model;
  }
}

TEST(ModelledFlow, OfABulgedSectionDropsLessPressureThanThatOfItsRectangle) {
  const double rectangle = drop(solve(membrane("rectangle"), kFast));
  const double momentum = drop(solve(membrane("momentum"), kFast));
  // 5 % of r where the mean deflection is a fifth of the height (docs/flow-models.md), of which
  // the wall, less lifted, takes a part back.
  EXPECT_LT(momentum, 0.99 * rectangle);
  EXPECT_GT(momentum, 0.93 * rectangle);
}

TEST(ModelledFlow, BehindASharpInletPaysForItsDevelopment) {
  Scenario scenario = membrane("plane-march");
  const double developed = drop(solve(scenario, kFast));
  scenario.solver.inlet_profile = "uniform";
  const CoupledFlow uniform = solve(scenario, kFast);
  EXPECT_LT((uniform.pressure.values() - said_of(uniform, scenario).pressure).abs().maxCoeff(),
            1.01e-5 * drop(uniform));
  // 28 % under a wall that stands still (FlowModels), which this taut one nearly does.
  EXPECT_NEAR(drop(uniform) / developed, 1.28, 0.03);
}

TEST(ModelledFlow, DoesNotDependOnTheWayThroughLowerFlowRates) {
  const Scenario scenario = plate("section-march");
  const WallModel wall = scenario.wall_model();
  CoupledFlow by_steps =
      fill_channel(scenario.channel, wall, wall.rest(), Pressure{}, scenario.solver);
  for (const double q : {5.0, 20.0, 30.0}) {
    by_steps = solve_coupled(scenario.channel, scenario.fluid, wall, by_steps, q * mL_per_min,
                             scenario.outlet.pressure(q * mL_per_min), scenario.solver);
  }
  const CoupledFlow at_once = solve(scenario, 30.0 * mL_per_min);
  // Both start from the same flow of the rectangle, to its 1e-9.
  EXPECT_LT((by_steps.pressure.values() - at_once.pressure.values()).abs().maxCoeff(),
            1e-6 * drop(at_once));
}

TEST(ModelledFlow, IsTheSameOnOneOrTwoThreads) {
  Scenario scenario = plate("section-march");
  scenario.levels = {Pressure{}, 4.0 * kPa};
  scenario.flow_rates = {5.0 * mL_per_min, 20.0 * mL_per_min};
  const SolvedScenario one = solve_scenario(scenario, 1), two = solve_scenario(scenario, 2);
  for (std::size_t i = 0; i < one.runs.size(); ++i) {
    EXPECT_TRUE((one.runs[i].flow.pressure.values() == two.runs[i].flow.pressure.values()).all());
  }
}

TEST(ModelledFlow, WithoutFlowHasOnePressureEverywhere) {
  const CoupledFlow still = solve(membrane("section-march"), FlowRate{});
  EXPECT_EQ(still.pressure.values().minCoeff(), still.pressure.values().maxCoeff());
}

TEST(ModelledFlow, SaysWhereAndAtWhichFlowRateItSeparates) {
  // A soft wall that opens steeply before a fast flow.
  Scenario scenario = plate("section-march");
  scenario.wall.youngs_modulus = 20.0 * GPa;
  scenario.solver.steps = 60;
  const std::string answer = refusal(scenario, 120.0 * mL_per_min);
  EXPECT_NE(answer.find("separates from the wall at x = "), std::string::npos) << answer;
  EXPECT_NE(answer.find("120 mL/min"), std::string::npos) << answer;
  EXPECT_NE(answer.find("section-march"), std::string::npos) << answer;
}

TEST(ModelledFlow, SaysWhenItsStepsAreTooFew) {
  Scenario scenario = plate("plane-march");
  scenario.solver.steps = 10;
  EXPECT_NE(refusal(scenario, 30.0 * mL_per_min).find("10 steps do not resolve"),
            std::string::npos);
}

}  // namespace
}  // namespace manoscope::twin
