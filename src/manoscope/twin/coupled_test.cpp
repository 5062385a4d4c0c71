#include "manoscope/twin/coupled.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "manoscope/core/error.hpp"
#include "manoscope/flow/duct_resistance.hpp"
#include "manoscope/flow/one_dimensional.hpp"
#include "manoscope/twin/scenario.hpp"

namespace manoscope::twin {
namespace {

CoupledFlow at_rest(const Scenario& scenario, const WallModel& wall) {
  return fill_channel(scenario.channel, wall, wall.rest(), Pressure{}, scenario.solver);
}

CoupledFlow solve(const Scenario& scenario, FlowRate flow_rate) {
  const WallModel wall = scenario.wall_model();
  return solve_coupled(scenario.channel, scenario.fluid, wall, at_rest(scenario, wall), flow_rate,
                       scenario.outlet.pressure(flow_rate), scenario.solver);
}

CoupledFlow solve(Scenario scenario, FlowRate flow_rate, int steps) {
  scenario.solver.steps = steps;
  return solve(scenario, flow_rate);
}

/// A short plate on few cells: 3 mm x 1.7 mm nitride over 60 um.
Scenario short_plate() {
  Scenario scenario = small_s1();
  scenario.wall_law = WallLaw::foppl_von_karman;
  scenario.channel.length = scenario.wall.length = 3.0 * mm;
  scenario.channel.height = 60.0 * um;
  scenario.wall.thickness = 1.0 * um;
  scenario.wall.preload = {};
  scenario.wall_grid = {12, 4};
  scenario.solver.momentum_factor = 1.2;
  scenario.solver.steps = 80;
  return scenario;
}

std::string refusal(const Scenario& scenario, FlowRate flow_rate) {
  try {
    solve(scenario, flow_rate);
  } catch (const InputError& error) {
    return error.found();
  }
  return "a flow";
}

TEST(CoupledFlow, WithoutFlowHasOnePressureEverywhere) {
  const Scenario scenario = small_s1();
  const WallModel wall = scenario.wall_model();
  const CoupledFlow still =
      fill_channel(scenario.channel, wall, wall.rest(), 2.3 * kPa, scenario.solver);
  EXPECT_EQ(still.pressure.values().minCoeff(), 2300.0);
  EXPECT_EQ(still.pressure.values().maxCoeff(), 2300.0);
  const Array1 x = still.deflection.x();
  EXPECT_LT((still.deflection.values() - scenario.tapered_membrane().deflection(x, 2.3 * kPa))
                .abs()
                .maxCoeff(),
            1e-20);
  const CoupledFlow slow = solve_coupled(scenario.channel, scenario.fluid, wall, still, FlowRate{},
                                         2.3 * kPa, scenario.solver);
  EXPECT_EQ(slow.pressure.values().minCoeff(), 2300.0);
  EXPECT_EQ(slow.speed_index, 0.0);
}

TEST(CoupledFlow, SolvesTheSameProblemAsFixedPointIterationOfTheRigidModel) {
  const Scenario scenario = small_s1();
  const wall::TaperedMembrane wall = scenario.tapered_membrane();
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
    const CoupledFlow flow = solve(scenario, flow_rate, 960);
    const double drop = p(0) - outlet.si();
    // The trapezoid rule of the rigid model on 8000 intervals errs by step^2 (r'/r)/(12 l): 1e-6;
    // the turn of the wall where it passes flat costs as much on 960 steps.
    EXPECT_LT((flow.pressure(x) - p).abs().maxCoeff(), 5e-6 * drop);
    // The default of 240 steps: what the scenarios are made with.
    EXPECT_LT((solve(scenario, flow_rate).pressure(x) - p).abs().maxCoeff(), 1e-4 * drop);
  }
}

TEST(CoupledFlow, WithInertiaObeysItsDifferentialEquation) {
  // A wall that answers at x alone turns the momentum equation into
  //   (1 - S^2) dp/dx = -r Q + beta rho Q^2 (dA/dx at constant p)/A^3,
  // marched here from the outlet by the classical Runge-Kutta method.
  Scenario scenario = small_s1();
  scenario.wall.preload = {};  // no turn
  scenario.wall.prestress = 100.0 * MPa;
  scenario.solver.momentum_factor = 1.2;
  const wall::TaperedMembrane wall = scenario.tapered_membrane();
  const double q = (70.0 * mL_per_min).si(), w = scenario.channel.width.si();
  const double flux = 1.2 * scenario.fluid.density.si() * q * q;
  double largest_square = 0.0;
  const auto slope = [&](double x, double p) {
    const double h = scenario.channel.height.si() + wall.deflection(x, p), area = w * h;
    const double dx = 1e-9 * scenario.channel.length.si() + 1e-7 * x;
    const double widening =
        x <= dx || x >= scenario.channel.length.si() - dx
            ? 0.0
            : w * (wall.deflection(x + dx, p) - wall.deflection(x - dx, p)) / (2.0 * dx);
    const double square = flux * w * wall.compliance(x, p) / std::pow(area, 3);
    largest_square = std::max(largest_square, square);
    const double r = flow::duct_resistance(scenario.fluid.viscosity, scenario.channel.width,
                                           Length::from_si(h), flow::DuctFormula::series);
    return (-r * q + flux * widening / std::pow(area, 3)) / (1.0 - square);
  };
  const Index n = 20000;
  const double step = scenario.channel.length.si() / static_cast<double>(n);
  const Pressure outlet = scenario.outlet.pressure(FlowRate::from_si(q));
  // At the very ends the taper has a corner: start and stop one step inside, where p has hardly
  // moved.
  double p = outlet.si();
  for (Index i = n; i > 0; --i) {
    const double x = static_cast<double>(i) * step;
    const double inside = std::min(x, scenario.channel.length.si() - 1e-3 * step);
    const double k1 = slope(inside, p), k2 = slope(x - 0.5 * step, p - 0.5 * step * k1);
    const double k3 = slope(x - 0.5 * step, p - 0.5 * step * k2);
    const double k4 = slope(std::max(x - step, 1e-3 * step), p - step * k3);
    p -= step / 6.0 * (k1 + 2.0 * (k2 + k3) + k4);
  }
  const CoupledFlow flow = solve(scenario, 70.0 * mL_per_min);
  // Inertia moves the drop by percents; the differences of the marched equation err by 1e-5.
  EXPECT_NEAR((flow.inlet().si() - outlet.si()) / (p - outlet.si()), 1.0, 5e-5);
  EXPECT_NEAR(flow.speed_index * flow.speed_index / largest_square, 1.0, 1e-2);
  scenario.solver.momentum_factor = 0.0;
  const double creeping = solve(scenario, 70.0 * mL_per_min).inlet().si() - outlet.si();
  EXPECT_GT(std::abs(creeping / (p - outlet.si()) - 1.0), 0.02);
}

TEST(CoupledFlow, ConvergesWithFourthOrder) {
  // Where the wall has no sharp turn: a strong prestress, no preload. A quarter of the length, so
  // that few steps are fine ones in the end layers.
  Scenario scenario = small_s1();
  scenario.solver.momentum_factor = 1.2;
  scenario.channel.length = scenario.wall.length = 4.0 * mm;
  scenario.wall.prestress = 300.0 * MPa;
  scenario.wall.preload = {};
  const double exact = solve(scenario, 70.0 * mL_per_min, 640).inlet().si();
  const double coarse = std::abs(solve(scenario, 70.0 * mL_per_min, 160).inlet().si() - exact);
  const double fine = std::abs(solve(scenario, 70.0 * mL_per_min, 320).inlet().si() - exact);
  EXPECT_NEAR(std::log2(coarse / fine), 4.0, 0.5);
}

TEST(CoupledFlow, DropsMorePressureForMoreFlowButLessThanInProportion) {
  const Scenario scenario = small_s1();
  double last_drop = 0.0, last_resistance = 1e300;
  for (double q = 5.0; q <= 70.0; q += 13.0) {
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

TEST(CoupledFlow, ThroughAStiffWallIsPoiseuilleFlowWithOrWithoutInertia) {
  Scenario scenario = small_s1();
  scenario.wall.thickness = Length::from_si(1.0);
  scenario.wall.prestress = 1.0 * GPa;
  scenario.solver.momentum_factor = 1.2;
  const CoupledFlow flow = solve(scenario, 20.0 * mL_per_min);
  const double r = flow::duct_resistance(scenario.fluid.viscosity, scenario.channel.width,
                                         scenario.channel.height, flow::DuctFormula::series);
  const double drop = 20e-6 / 60.0 * r * scenario.channel.length.si();
  // 2 s0 t/a^2 = 2.8e15 Pa/m: the wall gives by 2 pm of 175 um, three times that in r.
  EXPECT_NEAR((flow.inlet() - flow.outlet()).si() / drop, 1.0, 1e-7);
}

TEST(CoupledFlow, OfAPlateIsWhatTurnsBetweenWallAndMomentumEquationSettleOn) {
  const Scenario scenario = short_plate();
  const FlowRate flow_rate = 20.0 * mL_per_min;
  const double q = flow_rate.si(), outlet = scenario.outlet.pressure(flow_rate).si();
  const CoupledFlow flow = solve(scenario, flow_rate);
  // Independent of the solver: the wall's own equilibria, trapezoid rule on many stations.
  wall::FopplVonKarmanOptions options;
  options.n_cells_x = scenario.wall_grid.n_cells_x;
  options.n_cells_z = scenario.wall_grid.n_cells_z;
  options.design_pressure = scenario.levels.back();
  const wall::FopplVonKarman plate(scenario.wall, options);
  const Index n = 600;
  const double w = scenario.channel.width.si(), step = 3e-3 / static_cast<double>(n);
  const Array1 x = Array1::LinSpaced(n + 1, 0.0, 3e-3);
  Array1 p = Array1::Constant(n + 1, outlet);
  wall::WallState state = plate.equilibrium(wall::WallLoad::along(x, p));
  for (int turn = 0; turn < 60; ++turn) {
    state = plate.equilibrium(wall::WallLoad::along(x, p), state);
    const Array1 gap = scenario.channel.height.si() + state.average_deflection(x);
    const Array1 friction =
        q * flow::duct_resistance(scenario.fluid.viscosity, scenario.channel.width, gap,
                                  flow::DuctFormula::series);
    const Array1 head = 0.6 * scenario.fluid.density.si() * q * q / (w * gap).square();
    Array1 next(n + 1);
    next(n) = outlet;
    for (Index i = n - 1; i >= 0; --i) {
      next(i) = next(i + 1) + 0.5 * step * (friction(i) + friction(i + 1)) + head(i + 1) - head(i);
    }
    const double change = (next - p).abs().maxCoeff();
    p = 0.5 * (p + next);
    if (change < 1e-7) break;
    ASSERT_LT(turn, 59) << "the turns do not settle: " << change << " Pa";
  }
  const double drop = p(0) - outlet;
  ASSERT_GT(drop, 100.0);
  // Trapezoid rule on 5 um: (5 um/0.5 mm)^2/12 of the change of friction in the end layers.
  EXPECT_LT((flow.pressure(x) - p).abs().maxCoeff(), 3e-5 * drop);
  EXPECT_LT((flow.wall.deflection(x) - state.average_deflection(x)).abs().maxCoeff(),
            1e-4 * state.average_deflection(x).maxCoeff());
}

TEST(CoupledFlow, DoesNotDependOnTheWayThroughLowerFlowRates) {
  const Scenario scenario = short_plate();
  const WallModel wall = scenario.wall_model();
  CoupledFlow by_steps = at_rest(scenario, wall);
  for (const double q : {5.0, 12.0, 20.0}) {
    by_steps = solve_coupled(scenario.channel, scenario.fluid, wall, by_steps, q * mL_per_min,
                             scenario.outlet.pressure(q * mL_per_min), scenario.solver);
  }
  const CoupledFlow at_once = solve(scenario, 20.0 * mL_per_min);
  const double drop = (at_once.inlet() - at_once.outlet()).si();
  // Both meet the same equations to 1e-9 of the drop.
  EXPECT_LT((by_steps.pressure.values() - at_once.pressure.values()).abs().maxCoeff(), 1e-7 * drop);
}

TEST(CoupledFlow, SaysWhereTheWallTouchesTheFloor) {
  Scenario scenario = small_s1();
  scenario.channel.height = 8.0 * um;  // the preload bows the wall in by 17 um at its crest
  EXPECT_NE(refusal(scenario, FlowRate{}).find("touches the floor at x = "), std::string::npos);
  EXPECT_NE(refusal(scenario, 0.01 * mL_per_min).find("touches the floor at x = "),
            std::string::npos);
}

TEST(CoupledFlow, SeesAFoldThatTouchesTheFloorOffTheCentreLine) {
  // A wall that hangs down in two folds, beside its centre line: 50 um at a quarter of the width.
  WallModel wall;
  wall.length = 15.5 * mm;
  wall.load = [](const WallAtRest&, const Array1&, const Array1&) {
    WallAtRest made;
    made.shape = [](double, double z) {
      return -50e-6 * std::pow(std::sin(6.283185307179586 * z / 1.7e-3), 2);
    };
    made.deflection = [](const Array1& x) { return Array1(Array1::Constant(x.size(), -25e-6)); };
    return made;
  };
  flow::Channel channel = small_s1().channel;
  channel.height = 40.0 * um;
  try {
    fill_channel(channel, wall, {}, Pressure{});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(error.found().find("touches the floor at x = 0 mm, z = -0."), std::string::npos)
        << error.found();
  }
  channel.height = 51.0 * um;
  EXPECT_NO_THROW(fill_channel(channel, wall, {}, Pressure{}));
}

TEST(CoupledFlow, SaysWhenTheChannelChokes) {
  // A soft wall over a low gap and a fluid of little viscosity: S is much the same everywhere.
  Scenario scenario = small_s1();
  scenario.channel.height = 100.0 * um;
  scenario.wall.prestress = 60.0 * MPa;
  scenario.wall.youngs_modulus = 1.0 * GPa;
  scenario.wall.preload = {};
  scenario.solver.momentum_factor = 1.2;
  scenario.fluid.viscosity = 0.01 * mPa_s;
  scenario.outlet = {};
  double last = 0.0, flow_rate = 10.0;
  for (; flow_rate < 300.0; flow_rate *= 1.1) {
    const std::string answer = refusal(scenario, flow_rate * mL_per_min);
    if (answer != "a flow") {
      // Newton's method ends before S = 1: what is said of the last flow found is true of it.
      const auto at = answer.find("is close to choking: S^2 = ");
      ASSERT_NE(at, std::string::npos) << answer;
      const double square = std::stod(answer.substr(at + 27));
      EXPECT_LT(square, 1.0);
      EXPECT_GE(square, 0.7);
      break;
    }
    const double index = solve(scenario, flow_rate * mL_per_min).speed_index;
    EXPECT_GT(index, last);  // it nears 1 from below
    EXPECT_LT(index, 1.0);
    last = index;
  }
  ASSERT_LT(flow_rate, 300.0) << "the channel never choked";
  EXPECT_GT(last, 0.9);
  // Without inertia nothing chokes.
  scenario.solver.momentum_factor = 0.0;
  EXPECT_EQ(refusal(scenario, flow_rate * mL_per_min), "a flow");
}

TEST(CoupledFlow, SaysWhenItsStepsAreTooFew) {
  Scenario scenario = small_s1();
  scenario.channel.height = 18.0 * um;  // nearly closed: the pressure climbs within micrometres
  scenario.solver.steps = 20;
  EXPECT_NE(refusal(scenario, 0.001 * mL_per_min).find("20 steps do not resolve"),
            std::string::npos);
}

TEST(CoupledFlow, RefusesAWallOfAnotherLengthAndOptionsOutOfRange) {
  const Scenario scenario = small_s1();
  Scenario shorter = scenario;
  shorter.wall.length = 10.0 * mm;
  const WallModel wall = shorter.wall_model();
  EXPECT_THROW(fill_channel(scenario.channel, wall, wall.rest(), Pressure{}), InputError);
  for (const int steps : {5, 11, 4000}) {
    EXPECT_THROW(solve(scenario, FlowRate{}, steps), InputError) << steps;
  }
  CoupledOptions options;
  options.momentum_factor = -1.0;
  EXPECT_THROW(options.validate(), InputError);
}

}  // namespace
}  // namespace manoscope::twin
