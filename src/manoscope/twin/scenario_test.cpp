#include "manoscope/twin/scenario.hpp"

#include <gtest/gtest.h>

#include <string>

#include "manoscope/core/error.hpp"
#include "manoscope/twin/virtual_experiment.hpp"

namespace manoscope::twin {
namespace {

TEST(SmallS1, IsBowedAtRestAndStretchedAtFiftyKilopascal) {
  const Scenario scenario = small_s1();
  EXPECT_NO_THROW(scenario.validate());
  const wall::TaperedMembrane wall = scenario.tapered_membrane();
  const double middle = 0.5 * scenario.channel.length.si();
  // An independent plate model of the paper's S1 gives -11.4 um and 47.4 um.
  EXPECT_NEAR(wall.deflection(middle, 0.0), -11.4e-6, 1e-6);
  EXPECT_NEAR(wall.deflection(middle, 50e3), 47.4e-6, 0.5e-6);
}

TEST(SmallS1, CoversItsFlowRunsWithItsLevels) {
  const Scenario scenario = small_s1();
  const WallModel wall = scenario.wall_model();
  const CoupledFlow start =
      fill_channel(scenario.channel, wall, wall.rest(), Pressure{}, scenario.solver);
  for (const FlowRate flow_rate : scenario.flow_rates) {
    const CoupledFlow flow = solve_coupled(scenario.channel, scenario.fluid, wall, start, flow_rate,
                                           scenario.outlet.pressure(flow_rate), scenario.solver);
    EXPECT_LT(flow.inlet(), scenario.levels.back());
    EXPECT_GT(flow.outlet(), scenario.levels.front());
  }
}

TEST(Scenario, RefusesValuesOutOfRangeByName) {
  const auto refused = [](auto change, const std::string& part) {
    Scenario scenario = small_s1();
    change(scenario);
    try {
      scenario.validate();
      ADD_FAILURE() << part << " passed";
    } catch (const InputError& error) {
      EXPECT_NE(error.found().find(part), std::string::npos) << error.what();
    }
  };
  refused([](Scenario& s) { s.wall.thickness = -0.2 * um; }, "thickness");
  refused([](Scenario& s) { s.channel.height = Length{}; }, "height");
  refused([](Scenario& s) { s.wall.width = 1.6 * mm; }, "by 1.6 mm");
  refused([](Scenario& s) { s.levels.clear(); }, "no pressure level");
  refused([](Scenario& s) { s.levels.push_back(-5.0 * Pa); }, "-5 Pa");
  refused([](Scenario& s) { s.levels.push_back(1.0 * kPa); }, "1000 Pa follows 50000 Pa");
  refused([](Scenario& s) { s.wall.prestress = Pressure{}; }, "without prestress");
  refused([](Scenario& s) { s.flow_rates.push_back(5.0 * mL_per_min); }, "twice");
  refused([](Scenario& s) { s.flow_rates.push_back(FlowRate{}); }, "0 mL/min");
  refused([](Scenario& s) { s.fluid.viscosity = Viscosity{}; }, "viscosity");
  refused([](Scenario& s) { s.gauge.noise = -1.0 * Pa; }, "gauge noise");
  refused([](Scenario& s) { s.gauge.gain_uncertainty = 0.5; }, "gain");
  refused([](Scenario& s) { s.camera.spikes = 2.0; }, "spikes");
  refused([](Scenario& s) { s.solver.steps = 1; }, "steps");
  refused([](Scenario& s) { s.name.clear(); }, "no name");
}

TEST(Scenario, TakesALevelTwiceInARow) {
  Scenario scenario = small_s1();
  scenario.levels.push_back(scenario.levels.back());
  EXPECT_NO_THROW(scenario.validate());
}

TEST(Scenario, RefusesALevelThatLiftsTheWallBeyondItsTheory) {
  Scenario scenario = small_s1();
  scenario.wall_law = WallLaw::foppl_von_karman;
  scenario.wall = {15.5 * mm, 1.7 * mm, 100.0 * um, 1.0 * MPa, 0.49, Pressure{}};
  // 100 um of 1 MPa, 1.7 mm wide: 24 D z/a^4 + (4/3) E/(1 - nu^2) t z^3/a^4 at z = 0.4 a is 15 kPa.
  scenario.levels = {Pressure{}, 10.0 * kPa};
  EXPECT_NO_THROW(scenario.validate());
  scenario.levels.push_back(30.0 * kPa);
  try {
    make_virtual_experiment(scenario, 1);
    FAIL();
  } catch (const InputError& error) {
    const std::string told = error.what();
    for (const char* part : {"S1 (virtual)", "level of 30000 Pa", "0.4 of its half-width",
                             "Give levels up to about"}) {
      EXPECT_NE(told.find(part), std::string::npos) << told;
    }
  }
}

}  // namespace
}  // namespace manoscope::twin
