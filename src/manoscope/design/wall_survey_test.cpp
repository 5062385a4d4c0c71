#include "manoscope/design/wall_survey.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "manoscope/core/error.hpp"

namespace manoscope::design {
namespace {

/// 1 um of nitride over a short channel.
twin::Scenario short_plate(Length width, Pressure prestress) {
  twin::Scenario scenario = twin::small_s1();
  scenario.name = "short plate";
  scenario.channel = {3.0 * mm, width, 60.0 * um};
  scenario.wall = {3.0 * mm, width, 1.0 * um, 250.0 * GPa, 0.23, prestress};
  scenario.wall_law = twin::WallLaw::foppl_von_karman;
  scenario.wall_grid = {12, 4};
  scenario.flow_rates.clear();
  return scenario;
}

TEST(WallSurvey, HasTheMembranesOwnCurve) {
  const twin::Scenario scenario = twin::small_s1();
  const WallSurvey survey = survey_wall(scenario, 20.0 * kPa, 0.1 * Pa);
  const wall::TaperedMembrane wall = scenario.tapered_membrane();
  const double middle = 0.5 * scenario.channel.length.si();
  for (const double p : {0.0, 123.0, 690.0, 712.0, 5000.0, 19999.0, 22000.0}) {
    // p is a cubic in zeta: round-off, also a little beyond the last node.
    EXPECT_NEAR(survey.curve().deflection(p) / wall.deflection(middle, p), 1.0, 1e-9) << p;
    EXPECT_NEAR(survey.curve().compliance(p) / wall.compliance(middle, p), 1.0, 1e-6) << p;
  }
  EXPECT_TRUE(survey.snaps().empty());
  EXPECT_FALSE(survey.two_states());
  EXPECT_EQ(survey.half_wavelength(5.0 * kPa, scenario.channel.width), 0.0);
}

TEST(WallSurvey, MeetsAPlateBetweenItsNodes) {
  const twin::Scenario scenario = short_plate(0.5 * mm, 200.0 * MPa);
  const WallSurvey survey = survey_wall(scenario, 50.0 * kPa, 5.0 * Pa);
  const Array1 middle = Array1::Constant(1, 1.5e-3);
  const auto& states = survey.states();
  for (std::size_t k = 1; k < states.size(); ++k) {
    const double p = 0.6 * states[k - 1].pressure + 0.4 * states[k].pressure;
    const Pressure load = Pressure::from_si(p);
    const double solved = survey.loaded(load, load).deflection(middle)[0];
    EXPECT_NEAR(survey.curve().deflection(p), solved, 5.0 * survey.curve().compliance(p)) << p;
  }
  // A wall under isotropic tension: zeta - (w/pi)^2 zeta'' = c p, half at 2 w. It bends, too.
  const double half = survey.half_wavelength(100.0 * Pa, scenario.channel.width);
  EXPECT_NEAR(half / (2.0 * 0.5e-3), 1.0, 0.15);
}

TEST(WallSurvey, FindsASnapAndTheTwoStatesBelowIt) {
  // Three times what buckles it.
  twin::Scenario scenario = short_plate(1.7 * mm, Pressure::from_si(-1.6e6));
  scenario.wall.initial_shape.crest = -0.05 * um;
  const WallSurvey survey = survey_wall(scenario, 1.0 * kPa, 0.01 * Pa);
  ASSERT_FALSE(survey.snaps().empty());
  const SurveyedSnap& snap = survey.snaps().front();
  EXPECT_GT(snap.jump, 0.1e-6);
  EXPECT_LT(snap.between.high - snap.between.low, 0.2);
  EXPECT_GT(snap.between.low, 0.0);
  ASSERT_TRUE(survey.two_states());
  // Let down again it stays out, at rest too.
  EXPECT_EQ(survey.two_states()->low, 0.0);
  EXPECT_LE(survey.two_states()->high, snap.between.high);
}

TEST(WallSurvey, RefusesAWallOnTheFloor) {
  twin::Scenario scenario = twin::small_s1();
  scenario.channel.height = 12.0 * um;
  try {
    survey_wall(scenario, 5.0 * kPa, 0.1 * Pa);
    ADD_FAILURE() << "no error";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("touches the floor"), std::string::npos);
  }
}

TEST(WallCurve, OfAStifferWallIsTheSameAtHigherPressures) {
  const WallCurve curve = survey_wall(twin::small_s1(), 20.0 * kPa, 0.1 * Pa).curve();
  const WallCurve stiffer = curve.scaled(1.3);
  for (const double p : {10.0, 700.0, 9000.0}) {
    EXPECT_NEAR(stiffer.deflection(1.3 * p), curve.deflection(p), 1e-15);
    EXPECT_NEAR(stiffer.compliance(1.3 * p) / (curve.compliance(p) / 1.3), 1.0, 1e-9);
  }
}

}  // namespace
}  // namespace manoscope::design
