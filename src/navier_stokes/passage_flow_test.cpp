#include "passage_flow.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "manoscope/core/error.hpp"
#include "tests/support/quiet_traps.hpp"

namespace manoscope::navier_stokes {
namespace {

/// A channel of 1 by 0.1 mm and passages of 3 mm of its own section.
SimulatedPassage passage_at(PassageEnd end, double reynolds) {
  SimulatedPassage given;
  given.end = end;
  given.channel = {10.0 * mm, 1.0 * mm, 0.1 * mm};
  given.passage = {3.0 * mm, 1.0 * mm, 0.1 * mm};
  given.fluid = {1.0 * mPa_s, 1000.0 * kg_per_m3};
  given.flow_rate = FlowRate::from_si(reynolds * 1e-6 * 1e-3);  // Re = Q/(nu w)
  return given;
}

MeshOptions mesh_in(int dim) {
  MeshOptions mesh;
  mesh.dim = dim;
  return mesh;
}

double plate_drop(const SimulatedPassage& given) {
  const double h = given.passage.height.si();
  return 12.0 * given.fluid.viscosity.si() * given.flow_rate.si() * given.passage.length.si() /
         (given.passage.width.si() * h * h * h);
}

class PassageFlowTest : public testing::Test {
  test::QuietTraps traps_;  // MUMPS scales rows by what may be 0 / 0
};

TEST_F(PassageFlowTest, OfTheChannelsOwnSectionCostsWhatADuctDoes) {
  for (const PassageEnd end : {PassageEnd::inlet, PassageEnd::outlet}) {
    const SimulatedPassage given = passage_at(end, 200.0);
    const PassageFlow plane = simulate_passage(given, mesh_in(2));
    // A parabola and a linear pressure lie in the elements: round-off of the solver is left.
    EXPECT_NEAR(plane.drop / plate_drop(given), 1.0, 1e-8);
    EXPECT_LT(plane.drop_uncertainty, 1e-7 * plane.drop);
    const PassageFlow whole = simulate_passage(given, mesh_in(3));
    const double duct =
        flow::passage_drop(given.fluid.viscosity, given.flow_rate, given.passage).si();
    // Four cells up and some six across half the width: within its own numerical uncertainty.
    EXPECT_NEAR(whole.drop, duct, whole.drop_uncertainty);
    EXPECT_LT(whole.drop_uncertainty, 5e-3 * duct);
  }
}

/// Length of the eddy behind a step to twice the gap, in heights of the step.
double reattachment(double reynolds) {
  SimulatedPassage given = passage_at(PassageEnd::outlet, reynolds);
  given.passage.height = 0.2 * mm;
  FlowSolver<2> solver(passage_problem<2>(given, mesh_in(2), false));
  solver.solve();
  constexpr double kBeside = 1e-3;  // gaps below the roof: shear by the velocity there
  double before = 0.5, behind = 20.0;
  while (behind - before > 1e-4) {
    const double middle = 0.5 * (before + behind);
    (solver.at({middle, 2.0 - kBeside}).velocity[0] < 0.0 ? before : behind) = middle;
  }
  return before;
}

TEST_F(PassageFlowTest, ReattachesBehindAStepWhereOthersFindIt) {
  // E. Erturk, Computers & Fluids 37 (2008) 633, Re of the hydraulic diameter: 2 Re here. His
  // numbers as the Lethe project quotes them (examples/incompressible-flow/2d-backward-facing-step,
  // benchmark-data.txt). Our cells leave 1 %.
  EXPECT_NEAR(reattachment(50.0) / 2.922, 1.0, 0.01);
  EXPECT_NEAR(reattachment(100.0) / 4.982, 1.0, 0.01);
}

/// Of a contraction: length of the eddy in its corner, in half gaps of the channel, and the drop
/// beside friction over twice the shear on the channel's wall.
struct Contraction {
  double eddy = 0.0, excess = 0.0;
};

/// Creeping flow through a contraction 4:1 between plates, from x = -`far` on; one half: the floor
/// is the plane of symmetry.
Contraction contraction(FlowProblem<2> problem, double far) {
  problem.sides[SideName::floor].condition = SideCondition::slip;
  problem.sides[SideName::inlet] = {SideCondition::velocity, [](const Vector<2>& at) {
                                      return Vector<2>{16.0 - at[1] * at[1], 0.0};
                                    }};
  problem.sides[SideName::outlet].condition = SideCondition::open;
  problem.inlet_flow = 1.0;
  FlowSolver<2> solver(problem);
  solver.solve();
  double before = -4.0, behind = -0.5;  // the eddy in the corner, by the velocity beside the roof
  while (behind - before > 1e-4) {
    const double middle = 0.5 * (before + behind);
    (solver.at({middle, 4.0 - 4e-3}).velocity[0] > 0.0 ? before : behind) = middle;
  }
  const double wall_shear = 3.0;
  const double friction = 3.0 * far / 64.0 + 3.0 * 3.0;
  const double excess =
      solver.section(-far).mean_pressure - solver.section(3.0).mean_pressure - friction;
  return {-before, excess / (2.0 * wall_shear)};
}

/// Ends of cells from a place on, each half as large again as the one before, up to 0.2.
std::vector<double> growing(double from, double to, double first) {
  constexpr double kFactor = 1.5, kLargest = 0.2;
  std::vector<double> edges(1, from);
  const double sign = to > from ? 1.0 : -1.0;
  for (double size = first; sign * (to - edges.back()) > 1.5 * size;
       size = std::min(kFactor * size, kLargest)) {
    edges.push_back(edges.back() + sign * size);
  }
  edges.push_back(to);
  if (sign < 0.0) std::reverse(edges.begin(), edges.end());
  return edges;
}

TEST_F(PassageFlowTest, EntersANarrowerChannelAsCreepingFlowDoes) {
  // The problem of M. A. Alves, P. J. Oliveira & F. T. Pinho, J. Non-Newtonian Fluid Mech. 110
  // (2003) 45, at no elasticity.
  SimulatedPassage given = passage_at(PassageEnd::inlet, 1e-6);
  given.passage.height = 0.4 * mm;
  const Contraction found = contraction(passage_problem<2>(given, mesh_in(2), false), 10.0);
  // Once more on another mesh: cubic, the cells of another grading and ten times as small at the
  // edge, and more of both channels.
  constexpr double kSmall = 1.0 / 4000.0;
  FlowProblem<2> fine;
  fine.order = 3;
  fine.edges[0] = growing(0.0, -14.0, kSmall);
  const auto behind = growing(0.0, 4.0, kSmall);
  fine.edges[0].insert(fine.edges[0].end(), behind.begin() + 1, behind.end());
  fine.edges[1] = growing(1.0, 0.0, kSmall);
  const auto above = growing(1.0, 4.0, kSmall);
  fine.edges[1].insert(fine.edges[1].end(), above.begin() + 1, above.end());
  fine.place = [](const Vector<2>& chart) { return chart; };
  fine.solid = [](const Vector<2>& chart) { return chart[0] > 0.0 && chart[1] > 1.0; };
  fine.reynolds = 1e-6;
  const Contraction exact = contraction(fine, 10.0);
  EXPECT_NEAR(found.eddy / exact.eddy, 1.0, 0.01);
  EXPECT_NEAR(found.excess / exact.excess, 1.0, 0.01);
  RecordProperty("eddy", std::to_string(exact.eddy));
  RecordProperty("excess", std::to_string(exact.excess));
}

TEST_F(PassageFlowTest, LosesNoFluidOnItsWay) {
  for (const PassageEnd end : {PassageEnd::inlet, PassageEnd::outlet}) {
    SimulatedPassage given = passage_at(end, 50.0);
    given.passage.height = 0.25 * mm;
    given.port = 0.6 * mm;
    FlowSolver<2> solver(passage_problem<2>(given, mesh_in(2), false));
    solver.solve();
    const double sign = end == PassageEnd::inlet ? 1.0 : -1.0;
    const int channel = end == PassageEnd::inlet ? SideName::outlet : SideName::inlet;
    // Given velocities are scaled to the flow; in all, div u = 0 is met exactly, in a section
    // within what the cells tell of the velocity there.
    EXPECT_NEAR(sign * solver.side(SideName::roof).outflow, -1.0, 1e-9);
    EXPECT_NEAR(sign * solver.side(channel).outflow, 1.0, 1e-9);
    for (const double s : {-2.0, -0.5, -0.01, 0.01, 0.5, 2.0, 10.0, 20.0}) {
      EXPECT_NEAR(solver.section(-sign * s).flow, 1.0, 2e-3) << s;
    }
  }
}

TEST_F(PassageFlowTest, HoldsItsErrorWhereAnExpansionGivesBackWhatFrictionTakes) {
  SimulatedPassage given = passage_at(PassageEnd::outlet, 50.0);
  given.passage.height = 0.2 * mm;
  given.passage.length = 1.0 * mm;
  const PassageFlow found = simulate_passage(given, mesh_in(2));
  const double speed = given.flow_rate.si() / 1e-7;
  const double pressure = 500.0 * speed * speed + plate_drop(given);
  EXPECT_LT(std::abs(found.drop), 0.05 * pressure);
  EXPECT_TRUE(found.converged);
  EXPECT_GE(found.drop_uncertainty, 0.99 * 2e-3 * pressure);
  MeshOptions cubic = mesh_in(2);
  cubic.order = 3;
  const PassageFlow exact = simulate_passage(given, cubic);
  EXPECT_LT(std::abs(found.drop - exact.drop), found.drop_uncertainty);
}

TEST_F(PassageFlowTest, DoesNotDependOnHowMuchIsSolvedBeforeIt) {
  // A port half as long as now would move the drop by 0.5 %, a wider section by 0.1 %.
  SimulatedPassage given = passage_at(PassageEnd::inlet, 690.0);
  given.passage.length = 0.6 * mm;
  given.port = 0.3 * mm;
  const PassageFlow found = simulate_passage(given, mesh_in(2));
  given.stretch = 2.0;
  const PassageFlow longer = simulate_passage(given, mesh_in(2));
  EXPECT_LT(std::abs(longer.drop - found.drop), 0.5 * found.drop_uncertainty);
}

TEST_F(PassageFlowTest, SolvesAsMuchAsAJetNeedsOrCountsTheRestAsUncertain) {
  SimulatedPassage given = passage_at(PassageEnd::outlet, 690.0);
  given.beyond_height = 0.2 * mm;
  given.beyond_width = given.passage.width;
  // The main eddy behind a step 1:2 alone is some 0.05 Re of the gap long (Erturk).
  const PassageGeometry plane(given, 2);
  EXPECT_GT(plane.far.length / given.beyond_height, 70.0);
  EXPECT_EQ(plane.missing, 0.0);
  const PassageGeometry whole(given, 3);
  EXPECT_NEAR(whole.far.length / given.beyond_height, 20.0, 1e-9);
  EXPECT_NEAR(whole.missing, 1.0 - 20.0 / 73.0, 1e-9);
}

std::string refusal(const SimulatedPassage& given, int dim) {
  try {
    simulate_passage(given, mesh_in(dim));
  } catch (const InputError& error) {
    return error.found();
  }
  return "";
}

TEST_F(PassageFlowTest, RefusesWhatDoesNotFit) {
  SimulatedPassage given = passage_at(PassageEnd::inlet, 10.0);
  given.port = 4.0 * mm;
  EXPECT_NE(refusal(given, 3).find("longer than the passage"), std::string::npos);
  given.port = 1.0 * mm;
  given.port_side = PortSide::side;
  EXPECT_NE(refusal(given, 2).find("no side"), std::string::npos);
  given.beyond_height = -2.0 * mm;
  EXPECT_NE(refusal(given, 3).find("section beyond"), std::string::npos);
  given.beyond_height = given.beyond_width = 2.0 * mm;
  EXPECT_NE(refusal(given, 3).find("both"), std::string::npos);
  given.port = Length{};
  given.beyond_height = 0.05 * mm;
  EXPECT_NE(refusal(given, 3).find("does not hold"), std::string::npos);
  given.flow_rate = FlowRate{};
  EXPECT_NE(refusal(given, 3).find("flow rate"), std::string::npos);
}

}  // namespace
}  // namespace manoscope::navier_stokes
