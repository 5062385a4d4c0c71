#include "manoscope/twin/scenario_text.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <string>

#include "manoscope/core/options.hpp"
#include "manoscope/twin/scenario_file.hpp"

namespace manoscope::twin {
namespace {

/// Ten digits are written.
void expect_near(double a, double b, const std::string& what) {
  EXPECT_NEAR(a, b, 1e-9 * std::abs(a)) << what;
}

/// Options as texts: "0.0004 m", "true".
template <class Options>
void expect_same(const Options& a, const Options& b) {
  const auto left = list_options(a), right = list_options(b);
  for (std::size_t i = 0; i < left.size(); ++i) {
    char *left_unit = nullptr, *right_unit = nullptr;
    expect_near(std::strtod(left[i].value.c_str(), &left_unit),
                std::strtod(right[i].value.c_str(), &right_unit), left[i].name);
    EXPECT_STREQ(left_unit, right_unit) << left[i].name;
  }
}

void expect_same_scenario(const Scenario& a, const Scenario& b) {
  EXPECT_EQ(a.name, b.name);
  expect_near(a.channel.length.si(), b.channel.length.si(), "length");
  expect_near(a.channel.width.si(), b.channel.width.si(), "width");
  expect_near(a.channel.height.si(), b.channel.height.si(), "height");
  expect_near(a.height_uncertainty.si(), b.height_uncertainty.si(), "height uncertainty");
  expect_near(a.fluid.viscosity.si(), b.fluid.viscosity.si(), "viscosity");
  expect_near(a.fluid.density.si(), b.fluid.density.si(), "density");
  EXPECT_EQ(a.fluid_name, b.fluid_name);
  EXPECT_EQ(a.wall_law, b.wall_law);
  EXPECT_EQ(a.wall_material, b.wall_material);
  expect_near(a.wall.thickness.si(), b.wall.thickness.si(), "thickness");
  expect_near(a.wall.youngs_modulus.si(), b.wall.youngs_modulus.si(), "modulus");
  expect_near(a.wall.poisson_ratio, b.wall.poisson_ratio, "Poisson ratio");
  expect_near(a.wall.prestress.si(), b.wall.prestress.si(), "prestress");
  expect_near(a.wall.shear_correction, b.wall.shear_correction, "shear");
  expect_near(a.wall.preload.load.si(), b.wall.preload.load.si(), "preload");
  expect_near(a.wall.preload.lopsidedness, b.wall.preload.lopsidedness, "preload");
  expect_near(a.wall.initial_shape.crest.si(), b.wall.initial_shape.crest.si(), "crest");
  expect_near(a.wall.initial_shape.lopsidedness, b.wall.initial_shape.lopsidedness, "crest");
  ASSERT_EQ(a.levels.size(), b.levels.size());
  for (std::size_t k = 0; k < a.levels.size(); ++k) {
    expect_near(a.levels[k].si(), b.levels[k].si(), "level");
  }
  ASSERT_EQ(a.flow_rates.size(), b.flow_rates.size());
  for (std::size_t k = 0; k < a.flow_rates.size(); ++k) {
    expect_near(a.flow_rates[k].si(), b.flow_rates[k].si(), "flow rate");
  }
  expect_near(a.outlet.head.si(), b.outlet.head.si(), "outlet");
  expect_near(a.outlet.tubing_resistance, b.outlet.tubing_resistance, "tubing");
  for (const auto passage : {&Scenario::inlet_passage, &Scenario::outlet_passage}) {
    ASSERT_EQ((a.*passage).has_value(), (b.*passage).has_value());
    if (!(a.*passage)) continue;
    expect_near((a.*passage)->length.si(), (b.*passage)->length.si(), "passage");
    expect_near((a.*passage)->width.si(), (b.*passage)->width.si(), "passage");
    expect_near((a.*passage)->height.si(), (b.*passage)->height.si(), "passage");
  }
  EXPECT_EQ(a.camera.flow, b.camera.flow);
  EXPECT_EQ(a.camera.outward, b.camera.outward);
  expect_same(a.camera, b.camera);
  expect_same(a.gauge, b.gauge);
  expect_same(a.pump, b.pump);
  expect_same(a.solver, b.solver);
  expect_same(a.wall_grid, b.wall_grid);
}

TEST(ScenarioText, OfEveryShippedScenarioReadsBackAsTheSame) {
  for (const ShippedScenario& shipped : shipped_scenarios()) {
    const Scenario scenario = find_scenario(shipped.name);
    expect_same_scenario(scenario, parse_scenario(scenario_toml(scenario), "again.toml"));
  }
}

TEST(ScenarioText, KeepsWhatNoShippedScenarioHas) {
  Scenario scenario = small_s1();
  scenario.name = "a \"quoted\" name";
  scenario.flow_rates.clear();
  scenario.inlet_passage.reset();
  scenario.outlet_passage.reset();
  scenario.levels = {Pressure{}, 1.0 * kPa, 1.0 * kPa, 2345.6 * Pa};
  scenario.camera.flow = FlowDirection::minus_rows;
  scenario.camera.outward = Outward::minus_height;
  scenario.camera.across_reversed = true;
  scenario.camera.rotation = 2.0 * deg;
  scenario.gauge.gain_uncertainty = 0.002;
  scenario.gauge.zero_uncertainty = 5.0 * Pa;
  scenario.pump.pulsation = 1e-3;
  scenario.solver = {};
  scenario.solver.flow_model = "section-march";
  scenario.solver.inlet_profile = "uniform";
  const std::string text = scenario_toml(scenario, "two lines\nof comment");
  EXPECT_EQ(text.rfind("# two lines\n# of comment\nscenario = 1\n", 0), 0u);
  Scenario back = parse_scenario(text, "again.toml");
  EXPECT_NEAR(back.camera.rotation.si(), scenario.camera.rotation.si(), 1e-11);
  back.camera.rotation = scenario.camera.rotation;  // ten digits of mrad
  back.outlet = scenario.outlet;                    // without a flow there is none
  expect_same_scenario(scenario, back);
}

}  // namespace
}  // namespace manoscope::twin
