#include "manoscope/design/plan.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "manoscope/core/error.hpp"

namespace manoscope::design {
namespace {

/// The small S1 through a small camera.
twin::ScenarioDraft small_draft() {
  twin::ScenarioDraft draft;
  draft.scenario = twin::small_s1();
  draft.scenario.camera.n_along = 256;
  draft.scenario.camera.n_across = 64;
  draft.scenario.camera.blobs = 0.0;
  draft.scenario.flow_rates = {20.0 * mL_per_min, 70.0 * mL_per_min};
  draft.has_levels = true;
  return draft;
}

/// 1 um of nitride over 3 mm.
twin::ScenarioDraft plate_draft(Pressure prestress) {
  twin::ScenarioDraft draft = small_draft();
  twin::Scenario& scenario = draft.scenario;
  scenario.channel = {3.0 * mm, 1.7 * mm, 60.0 * um};
  scenario.wall = {3.0 * mm, 1.7 * mm, 1.0 * um, 250.0 * GPa, 0.23, prestress};
  scenario.wall_law = twin::WallLaw::foppl_von_karman;
  scenario.wall_grid = {12, 4};
  scenario.flow_rates.clear();
  scenario.levels = {Pressure{}};
  draft.has_levels = false;
  return draft;
}

std::string fault_of(const twin::ScenarioDraft& draft, const Wish& wish) {
  try {
    make_plan(draft, wish, 1);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Plan, TakesItsRangeFromTheRuns) {
  Wish wish;
  wish.levels = 9;
  const Plan plan = make_plan(small_draft(), wish, 1);
  ASSERT_EQ(plan.planned.runs.size(), 2u);
  EXPECT_LT(plan.range.low, plan.planned.runs[0].outlet);
  EXPECT_GT(plan.range.high, plan.planned.runs[1].inlet);
  EXPECT_EQ(plan.planned.levels.size(), 9u);
  EXPECT_GE(plan.planned.levels.back(), plan.range.high);
  EXPECT_EQ(plan.scenario.levels.size(), 9u);
  EXPECT_NO_THROW(plan.scenario.validate());
  EXPECT_EQ(plan.others.size(), 4u);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_LE(plan.planned.over.rms, plan.others[i].over.rms);
  for (const RunForecast& run : plan.planned.runs) {
    EXPECT_LE(run.rms, run.worst);
    EXPECT_GT(run.rms_error, 0.0);
    EXPECT_GT(run.drop_uncertainty, 0.0);
  }
  EXPECT_FALSE(plan.through_wall);  // it answers to the pressure at x alone
  EXPECT_TRUE(plan.answers.empty());
}

TEST(Plan, SplitsEveryReadingIntoItsSources) {
  Wish wish;
  wish.levels = 8;
  const Plan plan = make_plan(small_draft(), wish, 1);
  for (const PlannedReading& reading : plan.readings) {
    double squares = 0.0;
    for (const auto& source : reading.sources) squares += source.second * source.second;
    // The larger of what is stated and the error.
    EXPECT_GE(reading.uncertainty, 0.999 * std::sqrt(squares));
    EXPECT_GE(reading.uncertainty, 0.999 * reading.error);
    EXPECT_GT(reading.compliance, 0.0);
  }
}

TEST(Plan, FindsTheFewestLevelsForAWishAndSaysSo) {
  Wish wish;
  wish.lowest = 300.0 * Pa;
  wish.highest = 10.0 * kPa;
  wish.uncertainty = 20.0 * Pa;
  wish.drop_uncertainty = 30.0 * Pa;
  wish.resolution = 0.5 * mm;
  twin::ScenarioDraft draft = small_draft();
  draft.scenario.flow_rates.clear();
  const Plan plan = make_plan(draft, wish, 1);
  EXPECT_LE(plan.planned.over.worst, 20.0);
  EXPECT_LE(plan.planned.drop, 30.0);
  ASSERT_EQ(plan.answers.size(), 3u);
  for (const WishAnswer& answer : plan.answers) EXPECT_TRUE(answer.met) << answer.text;
  wish.levels = static_cast<int>(plan.planned.levels.size()) - 1;
  const Plan fewer = make_plan(draft, wish, 1);
  EXPECT_TRUE(fewer.planned.over.worst > 20.0 || fewer.planned.drop > 30.0);
}

TEST(Plan, SaysWhatWouldDoWhereAWishIsNotMet) {
  Wish wish;
  wish.highest = 10.0 * kPa;
  wish.levels = 16;
  wish.uncertainty = 11.0 * Pa;
  twin::ScenarioDraft draft = small_draft();
  draft.scenario.flow_rates.clear();
  draft.scenario.gauge.noise = 20.0 * Pa;
  const Plan plan = make_plan(draft, wish, 1);
  ASSERT_EQ(plan.answers.size(), 1u);
  EXPECT_FALSE(plan.answers[0].met);
  EXPECT_NE(plan.answers[0].text.find("not met by 16 maps"), std::string::npos);
  EXPECT_NE(plan.answers[0].text.find("gauge noise"), std::string::npos) << plan.answers[0].text;
}

TEST(Plan, WantsARange) {
  twin::ScenarioDraft draft = small_draft();
  draft.scenario.flow_rates.clear();
  EXPECT_NE(fault_of(draft, {}).find("no range of pressure"), std::string::npos);
  Wish wish;
  wish.highest = 10.0 * kPa;
  wish.lowest = 20.0 * kPa;
  EXPECT_NE(fault_of(draft, wish).find("--lowest"), std::string::npos);
  wish.lowest.reset();
  wish.highest_level = 9.0 * kPa;
  EXPECT_NE(fault_of(draft, wish).find("--highest-level"), std::string::npos);
}

TEST(Plan, RefusesPressuresBeyondTheWallsTheory) {
  twin::ScenarioDraft draft = small_draft();
  draft.scenario.flow_rates.clear();
  Wish wish;
  wish.highest = 50.0 * MPa;
  const std::string fault = fault_of(draft, wish);
  EXPECT_NE(fault.find("half-width"), std::string::npos) << fault;
}

TEST(Plan, RefusesAWallOnTheFloorAtRest) {
  twin::ScenarioDraft draft = small_draft();
  draft.scenario.channel.height = 12.0 * um;
  draft.scenario.flow_rates.clear();
  Wish wish;
  wish.highest = 10.0 * kPa;
  EXPECT_NE(fault_of(draft, wish).find("touches the floor"), std::string::npos);
}

TEST(Plan, GoesOnWithoutRunsThatChokeWhereTheRangeIsGiven) {
  twin::ScenarioDraft draft = small_draft();
  draft.scenario.solver.momentum_factor = 1.2;
  draft.scenario.flow_rates = {1000.0 * mL_per_min};
  Wish wish;
  wish.levels = 6;
  const std::string fault = fault_of(draft, wish);
  EXPECT_NE(fault.find("Q1000"), std::string::npos) << fault;
  wish.highest = 10.0 * kPa;
  const Plan plan = make_plan(draft, wish, 1);
  EXPECT_TRUE(plan.planned.runs.empty());
  ASSERT_EQ(plan.notes.size(), 1u);
  EXPECT_NE(plan.notes[0].find("Q1000"), std::string::npos) << plan.notes[0];
}

TEST(Plan, LeavesOutWhereAWallHasTwoStates) {
  Wish wish;
  wish.highest = 2.0 * kPa;
  wish.levels = 7;
  twin::ScenarioDraft draft = plate_draft(Pressure::from_si(-1.6e6));
  draft.scenario.wall.initial_shape.crest = -0.05 * um;
  const Plan plan = make_plan(draft, wish, 1);
  EXPECT_GT(plan.range.low, 0.0);
  EXPECT_GT(plan.planned.levels.front(), 0.0);
  EXPECT_LE(plan.planned.levels.front(), plan.range.low);
  EXPECT_FALSE(plan.through_wall);
  std::string notes;
  for (const std::string& note : plan.notes) notes += note + "\n";
  EXPECT_NE(notes.find("snaps through"), std::string::npos) << notes;
  EXPECT_NE(notes.find("two states"), std::string::npos) << notes;
  EXPECT_TRUE(std::isfinite(plan.planned.over.worst));
}

TEST(Plan, ReadsAPlateThroughItsNeighbourhood) {
  Wish wish;
  wish.highest = 20.0 * kPa;
  wish.levels = 8;
  wish.resolution = 1.0 * mm;
  const Plan plan = make_plan(plate_draft(10.0 * MPa), wish, 1);
  EXPECT_TRUE(plan.through_wall);
  EXPECT_GT(plan.half_wavelength.low, 1e-3);
  EXPECT_LE(plan.half_wavelength.low, plan.half_wavelength.high);
  ASSERT_EQ(plan.answers.size(), 1u);
  EXPECT_FALSE(plan.answers[0].met);
  EXPECT_NE(plan.answers[0].text.find("goes with the width"), std::string::npos);
}

}  // namespace
}  // namespace manoscope::design
