#include "manoscope/calibration/levels.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "manoscope/core/error.hpp"
#include "manoscope/core/random.hpp"
#include "tests/support/local_wall.hpp"

namespace manoscope::calibration {
namespace {

using test::exact_profile;
using test::level;

const Array1 kX = Array1::LinSpaced(3, 1e-3, 3e-3);

Level plain(const std::string& name, double pressure, double uncertainty, double zeta) {
  Profile profile = exact_profile(kX, [&](double) { return zeta; });
  profile.uncertainty.independent.setConstant(4e-9);
  profile.uncertainty.modes.push_back({"plane of " + name, "leveling", Array1::Constant(3, 3e-9)});
  return level(name, pressure, uncertainty, profile);
}

TEST(SortLevels, GivesTheSameWhateverTheOrder) {
  std::vector<Level> levels{plain("a", 0, 0, 0), plain("b", -300, 10, -1e-6),
                            plain("c", 500, 10, 1e-6), plain("d", 500, 10, 1.2e-6),
                            plain("e", 9e3, 10, 5e-6)};
  const auto expected = sort_levels(levels);
  ASSERT_EQ(expected.size(), 4U);
  RandomStream stream(1, "order");
  for (int trial = 0; trial < 20; ++trial) {
    for (std::size_t k = levels.size() - 1; k > 0; --k) {
      std::swap(levels[k],
                levels[static_cast<std::size_t>(stream.below(static_cast<Index>(k) + 1))]);
    }
    const auto sorted = sort_levels(levels);
    ASSERT_EQ(sorted.size(), expected.size());
    for (std::size_t k = 0; k < sorted.size(); ++k) {
      EXPECT_EQ(sorted[k].name, expected[k].name);
      EXPECT_EQ(sorted[k].pressure, expected[k].pressure);
      EXPECT_TRUE((sorted[k].profile.zeta == expected[k].profile.zeta).all());
    }
  }
  for (std::size_t k = 1; k < expected.size(); ++k) {
    EXPECT_LT(expected[k - 1].pressure, expected[k].pressure);
  }
}

TEST(SortLevels, AveragesRepeatsWithTheUncertaintyOfAMean) {
  std::vector<Level> levels{plain("z", 0, 0, 0), plain("t", 9e3, 10, 5e-6)};
  for (const char* name : {"r1", "r2", "r3", "r4"}) {
    levels.push_back(plain(name, 500, 10, 1e-6 + 1e-7 * (name[1] - '1')));
  }
  const auto sorted = sort_levels(levels);
  ASSERT_EQ(sorted.size(), 3U);
  EXPECT_NEAR(sorted[1].uncertainty.si(), 10.0 / 2.0, 1e-12);  // 1/sqrt(4); round-off
  EXPECT_NEAR(sorted[1].profile.zeta[1], 1.15e-6, 1e-20);
  EXPECT_NEAR(sorted[1].profile.uncertainty.independent[0], 2e-9, 1e-22);
  // Four planes fitted apart: each counts a quarter, together sqrt(4)/4 of one.
  EXPECT_NEAR(sorted[1].profile.uncertainty.standard()[0], 0.5 * std::hypot(4e-9, 3e-9), 1e-21);
}

TEST(SortLevels, AveragesARepeatOnlyWhereItCounts) {
  std::vector<Level> levels{plain("z", 0, 0, 0), plain("t", 9e3, 10, 5e-6),
                            plain("r1", 500, 10, 1e-6), plain("r2", 500, 10, 2e-6)};
  levels[3].profile.flags[0] = StationFlag::no_data;
  levels[2].profile.flags[2] = levels[3].profile.flags[2] = StationFlag::no_data;
  const Profile mean = sort_levels(levels)[1].profile;
  EXPECT_NEAR(mean.zeta[0], 1e-6, 1e-20);
  EXPECT_NEAR(mean.zeta[1], 1.5e-6, 1e-20);
  EXPECT_EQ(mean.flags[0], 0);
  EXPECT_EQ(mean.flags[2], StationFlag::no_data);
}

TEST(SortLevels, KeepsRepeatedVentedMapsExactlyAtZero) {
  const auto sorted = sort_levels({plain("v1", 0, 0, 1e-8), plain("v2", 0, 0, -1e-8),
                                   plain("b", 100, 10, 1e-6), plain("c", 200, 10, 2e-6)});
  ASSERT_EQ(sorted.size(), 3U);
  EXPECT_EQ(sorted[0].pressure.si(), 0.0);
  EXPECT_EQ(sorted[0].uncertainty.si(), 0.0);
}

TEST(SortLevels, KeepsTheShareOfRepeatsThatTheGaugeRead) {
  std::vector<Level> levels{plain("v", 0, 0, 0), plain("b", 100, 10, 1e-6),
                            plain("c", 200, 10, 2e-6)};
  EXPECT_EQ(sort_levels(levels)[0].gauge_share, 0.0);
  EXPECT_EQ(sort_levels(levels)[1].gauge_share, 1.0);
  for (const char* name : {"g1", "g2", "g3"}) levels.push_back(plain(name, 0, 10, 1e-8));
  const auto sorted = sort_levels(levels);
  ASSERT_EQ(sorted.size(), 3U);
  EXPECT_EQ(sorted[0].gauge_share, 0.75);
  EXPECT_NEAR(sorted[0].uncertainty.si(), 10.0 * std::sqrt(3.0) / 4.0, 1e-12);
}

TEST(SortLevels, RefusesLevelsOnOtherStationsNamingTheMap) {
  std::vector<Level> levels{plain("a", 0, 0, 0), plain("b", 100, 10, 1e-6),
                            plain("odd", 200, 10, 2e-6)};
  for (const Array1& other :
       {Array1(Array1::LinSpaced(3, 1e-3, 3.1e-3)), Array1(Array1::LinSpaced(4, 1e-3, 3e-3))}) {
    levels[2].profile.x = other;
    try {
      sort_levels(levels);
      ADD_FAILURE() << "no error";
    } catch (const InputError& error) {
      EXPECT_EQ(error.where(), "odd");
    }
  }
}

TEST(SortLevels, RefusesFewerThanThreeDistinctPressures) {
  EXPECT_THROW(sort_levels({}), InputError);
  try {
    sort_levels({plain("a", 0, 0, 0), plain("b", 100, 10, 1e-6), plain("c", 100, 10, 1e-6)});
    ADD_FAILURE() << "no error";
  } catch (const InputError& error) {
    EXPECT_EQ(error.found(), "has 2 distinct pressures");
  }
}

}  // namespace
}  // namespace manoscope::calibration
