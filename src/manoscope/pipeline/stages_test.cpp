#include "manoscope/pipeline/stages.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "manoscope/pipeline/test_experiment.hpp"

namespace manoscope::pipeline {
namespace {

ReducedExperiment reduce(const experiment::Experiment& experiment) {
  return reduce_maps(experiment, place_channel(experiment).frame, {}, 1, {});
}

/// The experiment with a second map of level h10 and of run Q70.
experiment::Experiment with_repeats(TestExperiment& test) {
  const auto add = [&](const std::string& from, const std::string& name, std::uint64_t seed) {
    TestExperiment other(test.scenario, seed);
    test.twin.maps.push_back({name, name, other.map(from)});
  };
  add("h10.gsf", "again.gsf", 2);
  add("f01.gsf", "g01.gsf", 3);
  // The same label as the first map of the level has.
  const auto at = test.twin.hydrostatic_csv.find("h10.gsf") + 7;
  const auto end = test.twin.hydrostatic_csv.find(',', at + 1);
  test.twin.hydrostatic_csv +=
      "again.gsf" + test.twin.hydrostatic_csv.substr(at, end - at) + ",10,17\n";
  test.twin.flow_csv =
      "map,flow_rate [mL/min],pressure_drop [Pa],run\n"
      "f01.gsf,70,12000,fast\nf00.gsf,20,,slow\ng01.gsf,70,12100,fast\n";
  return test.read();
}

TEST(MakeRuns, AverageTheMapsOfARunAndItsTransducer) {
  TestExperiment test;
  const auto experiment = with_repeats(test);
  const ReducedExperiment reduced = reduce(experiment);
  const auto runs = make_runs(experiment, reduced.flow);
  ASSERT_EQ(runs.size(), 2u);
  EXPECT_EQ(runs[0].name, "fast");  // in the order of their first map
  EXPECT_EQ(runs[1].name, "slow");
  EXPECT_NEAR(runs[0].flow_rate.in(mL_per_min), 70.0, 1e-9);
  ASSERT_TRUE(runs[0].transducer_drop);
  EXPECT_EQ(*runs[0].transducer_drop, 12050.0 * Pa);
  EXPECT_FALSE(runs[1].transducer_drop);
  const Profile &a = reduced.flow[0].profile, &b = reduced.flow[2].profile;
  for (Index ix = 0; ix < a.x.size(); ++ix) {
    if (a.flags[ix] != 0 || b.flags[ix] != 0) continue;
    EXPECT_DOUBLE_EQ(runs[0].profile.zeta[ix], 0.5 * (a.zeta[ix] + b.zeta[ix]));
    EXPECT_NEAR(runs[0].profile.uncertainty.independent[ix],
                0.5 * std::hypot(a.uncertainty.independent[ix], b.uncertainty.independent[ix]),
                1e-15);
  }
  EXPECT_TRUE((runs[1].profile.zeta == reduced.flow[1].profile.zeta).all());
}

TEST(MakeRuns, RepeatsComeNearerToTheTruth) {
  TestExperiment test;
  const auto m = measure(with_repeats(test));
  const auto single = TestExperiment().measure();
  EXPECT_EQ(m.level_pressure.size(), single.level_pressure.size());  // 18 maps at 17 levels
  EXPECT_EQ(m.map.size(), 21u);
  EXPECT_EQ(m.transducer_drop[0], 12050.0);
  EXPECT_TRUE(std::isnan(m.transducer_drop[1]));
  const Index middle = m.x.size() / 2;
  // Everything in a profile's uncertainty is of its own map, but for the quadrature across the
  // width, the same share zeta (pitch / width)^2 of every profile: 64 rows over 2.5 mm.
  const double lost = std::pow(2.5 / 64.0 / 1.7, 2);
  const auto own = [lost](double uncertainty, double zeta) {
    return std::sqrt(uncertainty * uncertainty - lost * lost * zeta * zeta);
  };
  EXPECT_NEAR(own(m.deflection_uncertainty(0, middle), m.deflection(0, middle)) /
                  own(single.deflection_uncertainty(1, middle), single.deflection(1, middle)),
              std::sqrt(0.5), 0.05);
  EXPECT_NEAR(own(m.static_deflection_uncertainty(10, middle), m.static_deflection(10, middle)) /
                  own(single.static_deflection_uncertainty(10, middle),
                      single.static_deflection(10, middle)),
              std::sqrt(0.5), 0.05);
  EXPECT_NEAR(m.level_pressure_uncertainty[10], 10.0 * std::sqrt(0.5), 1e-9);
  EXPECT_NEAR(m.crest_deflection_uncertainty[10] / single.crest_deflection_uncertainty[10],
              std::sqrt(0.5), 0.05);
}

TEST(ReduceMaps, KeepsTheOrderOfTheLists) {
  TestExperiment test;
  const auto experiment = test.read();
  const ReducedExperiment reduced = reduce(experiment);
  ASSERT_EQ(reduced.hydrostatic.size(), 17u);
  ASSERT_EQ(reduced.flow.size(), 2u);
  ASSERT_EQ(reduced.hash.size(), 19u);
  for (std::size_t k = 0; k < 17; ++k) {
    EXPECT_EQ(reduced.hydrostatic[k].condition.name, experiment.hydrostatic[k].name);
  }
  EXPECT_EQ(reduced.flow[1].condition.name, "f01.gsf");
  const auto levels = make_levels(experiment, reduced.hydrostatic);
  ASSERT_EQ(levels.size(), 17u);
  EXPECT_EQ(levels[3].name, "h03.gsf");
  EXPECT_EQ(levels[0].uncertainty, Pressure{});  // vented
  EXPECT_EQ(levels[3].uncertainty, 10.0 * Pa);
}

TEST(PlaceChannel, IsFoundWithinAPixelOfTheTruth) {
  twin::Scenario scenario = small_scenario();
  scenario.camera.flow = FlowDirection::minus_rows;
  TestExperiment test(scenario);
  const ChannelFrame given = place_channel(test.read()).frame;
  test.leave_out_place();
  const maps::FoundPlace found = place_channel(test.read());
  EXPECT_EQ(found.frame.flow, FlowDirection::minus_rows);
  const auto truth = given.camera_from_channel(5e-3, 0.0);
  const auto there = found.frame.camera_from_channel(5e-3, 0.0);
  EXPECT_NEAR(there[0], truth[0], 39e-6);
  EXPECT_NEAR(there[1], truth[1], 64e-6);
  EXPECT_LT(std::abs(found.length_misfit), 0.1e-3);
}

}  // namespace
}  // namespace manoscope::pipeline
