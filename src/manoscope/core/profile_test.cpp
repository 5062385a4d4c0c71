#include "manoscope/core/profile.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "manoscope/core/flags.hpp"

namespace manoscope {
namespace {

Profile repeat(double level, const std::string& variable) {
  Profile profile;
  profile.x = Array1::LinSpaced(4, 0.0, 3e-3);
  profile.zeta = Array1::Constant(4, level);
  profile.flags = Flags1::Zero(4);
  profile.uncertainty.independent = Array1::Constant(4, 3e-9);
  profile.uncertainty.modes.push_back({variable, "leveling", Array1::Constant(4, 8e-9)});
  return profile;
}

TEST(MeanProfile, AveragesRepeatsAndTheirIndependentErrors) {
  const Profile mean =
      mean_profile({repeat(1e-6, "a"), repeat(2e-6, "b"), repeat(3e-6, "c"), repeat(6e-6, "d")});
  for (Index i = 0; i < 4; ++i) {
    EXPECT_NEAR(mean.zeta[i], 3e-6, 1e-20);
    EXPECT_NEAR(mean.uncertainty.independent[i], 3e-9 / 2.0, 1e-23);  // 1/sqrt(4)
  }
  ASSERT_EQ(mean.uncertainty.modes.size(), 4U);
  for (const ErrorMode& mode : mean.uncertainty.modes) {
    EXPECT_NEAR(mode.effect[2], 2e-9, 1e-23);  // 1/4 each, so 1/sqrt(4) together
    EXPECT_EQ(mode.source, "leveling");
  }
  EXPECT_NEAR(mean.uncertainty.standard()[1], std::hypot(3e-9, 8e-9) / 2.0, 1e-22);
}

TEST(MeanProfile, DoesNotReduceAnErrorThatRepeatsShare) {
  const Profile mean = mean_profile({repeat(1e-6, "mirror"), repeat(2e-6, "mirror")});
  ASSERT_EQ(mean.uncertainty.modes.size(), 1U);
  EXPECT_NEAR(mean.uncertainty.modes[0].effect[0], 8e-9, 1e-23);
}

TEST(MeanProfile, LeavesOutARepeatWhereItIsFlagged) {
  Profile bad = repeat(9e-6, "b");
  bad.flags[1] = bad.flags[3] = StationFlag::no_data;
  bad.zeta[1] = bad.zeta[3] = 0.0;
  Profile good = repeat(1e-6, "a");
  good.flags[3] = StationFlag::no_data;
  good.zeta[3] = 0.0;
  const Profile mean = mean_profile({good, bad});
  EXPECT_NEAR(mean.zeta[0], 5e-6, 1e-20);
  EXPECT_NEAR(mean.zeta[1], 1e-6, 1e-20);
  EXPECT_EQ(mean.flags[0], 0);
  EXPECT_EQ(mean.flags[1], 0);
  EXPECT_NEAR(mean.uncertainty.independent[1], 3e-9, 1e-23);
  EXPECT_NEAR(mean.uncertainty.modes[0].effect[1], 8e-9, 1e-23);
  EXPECT_EQ(mean.uncertainty.modes[1].effect[1], 0.0);
  // No repeat counts: flagged, and no number left behind.
  EXPECT_EQ(mean.flags[3], StationFlag::no_data);
  EXPECT_EQ(mean.zeta[3], 0.0);
  EXPECT_EQ(mean.uncertainty.standard()[3], 0.0);
}

TEST(MeanProfile, IsTheProfileItselfWithoutRepeats) {
  const Profile one = repeat(1e-6, "a");
  const Profile mean = mean_profile({one});
  EXPECT_TRUE((mean.zeta == one.zeta).all());
  EXPECT_EQ(mean.uncertainty.modes.size(), 1U);
}

}  // namespace
}  // namespace manoscope
