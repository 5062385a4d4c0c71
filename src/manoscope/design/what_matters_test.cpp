#include "manoscope/design/what_matters.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "manoscope/design/test_apparatus.hpp"

namespace manoscope::design {
namespace {

using test_support::bending_plate;
using test_support::bowed_membrane;
using test_support::task_of;

TEST(WhatMatters, ListsOnlyWhatCanBeImproved) {
  Apparatus apparatus = bending_plate();
  EXPECT_EQ(levers(apparatus), (std::vector<Lever>{Lever::gauge_noise, Lever::pixel_noise,
                                                   Lever::flow_maps, Lever::wall_stiffness}));
  apparatus.gauge.gain_uncertainty = 0.01;
  apparatus.gauge.zero_uncertainty = 3.0 * Pa;
  apparatus.gauge.noise = Pressure{};
  EXPECT_EQ(levers(apparatus),
            (std::vector<Lever>{Lever::pixel_noise, Lever::flow_maps, Lever::gauge_zero,
                                Lever::gauge_gain, Lever::wall_stiffness}));
}

TEST(WhatMatters, IsTheGaugeWhereLabelsRule) {
  const PlacementTask task = task_of(bending_plate(), 4000.0);
  const auto levels = even_levels(14, 0.0, 4200.0, true);
  const double before = uncertainty_over(task.apparatus, levels, task.target).rms;
  wall::ClampedWall wall{15.5 * mm, 1.7 * mm, 200.0 * um, 0.69 * MPa, 0.49};
  for (const Improvement& one : find_improvements(task, levels, wall)) {
    if (one.name == "gauge noise halved") {
      EXPECT_LT(one.over.rms, 0.75 * before);
    } else if (one.name == "every level twice") {
      EXPECT_LT(one.over.rms, 0.9 * before);
    } else {
      EXPECT_NEAR(one.over.rms / before, 1.0, 0.02) << one.name;
    }
  }
}

TEST(WhatMatters, IsTheWallWherePixelsRule) {
  // Ten times the noise: a softer wall shows more, as its own curve at the same pressures says.
  Apparatus apparatus = bowed_membrane();
  apparatus.maps.station_noise *= 10.0;
  const Apparatus softer = improved(apparatus, Lever::wall_stiffness, 0.5);
  const double p = 0.5 * apparatus.curve.highest();
  EXPECT_NEAR(softer.maps.station_noise / apparatus.maps.station_noise,
              apparatus.curve.compliance(p) / apparatus.curve.scaled(0.5).compliance(p), 1e-12);
  EXPECT_LT(softer.maps.station_noise, 0.9 * apparatus.maps.station_noise);
}

TEST(NeededShare, IsTheLargestThatDoes) {
  const PlacementTask task = task_of(bending_plate(), 4000.0);
  const auto levels = even_levels(14, 0.0, 4200.0, true);
  const auto enough = [&](const Apparatus& apparatus) {
    return uncertainty_over(apparatus, levels, task.target).worst <= 5.0;
  };
  ASSERT_FALSE(enough(task.apparatus));
  const auto share = needed_share(task.apparatus, Lever::gauge_noise, enough);
  ASSERT_TRUE(share);
  EXPECT_TRUE(enough(improved(task.apparatus, Lever::gauge_noise, *share)));
  EXPECT_FALSE(enough(improved(task.apparatus, Lever::gauge_noise, 1.05 * *share)));
  EXPECT_FALSE(needed_share(task.apparatus, Lever::pixel_noise, enough));
}

TEST(StillBears, TellsAWallThatWouldRiseTooHigh) {
  const PlacementTask task = task_of(bending_plate(), 4000.0);  // 80 um
  wall::ClampedWall wall{15.5 * mm, 1.7 * mm, 200.0 * um, 0.69 * MPa, 0.49};
  EXPECT_TRUE(still_bears(task, wall, 0.9));
  wall.width = 0.5 * mm;  // 100 um at most
  EXPECT_FALSE(still_bears(task, wall, 0.9));
}

}  // namespace
}  // namespace manoscope::design
