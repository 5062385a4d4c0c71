#include "manoscope/design/place_levels.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "manoscope/core/error.hpp"
#include "manoscope/design/choose_levels.hpp"
#include "manoscope/design/test_apparatus.hpp"

namespace manoscope::design {
namespace {

using test_support::bending_plate;
using test_support::bowed_membrane;
using test_support::task_of;

TEST(PlaceLevels, ServeBetterThanEvenAndLogSpacedOnes) {
  for (const Aim aim : {Aim::worst, Aim::rms}) {
    for (PlacementTask task :
         {task_of(bowed_membrane(), 17500.0), task_of(bending_plate(), 4000.0)}) {
      task.aim = aim;
      for (const int n : {8, 14}) {
        const auto placed = place_levels(task, n, 1);
        ASSERT_EQ(placed.size(), static_cast<std::size_t>(n));
        const double score = score_levels(task, placed);
        EXPECT_LT(score, score_levels(task, even_levels(n, 0.0, task.lowest_top, true)));
        EXPECT_LT(score, score_levels(task, best_log_spaced(task, n)));
        EXPECT_LT(score, score_levels(task, log_spaced(n, 300.0, task.lowest_top, true)));
      }
    }
  }
}

TEST(PlaceLevels, ComeNearTheBestOfAllOnAGrid) {
  PlacementTask task = task_of(bending_plate(), 4000.0);
  task.aim = Aim::worst;
  task.most_repeats = 5;
  constexpr int kSteps = 13;
  const auto at = [&](int i) { return task.highest_level * i / kSteps; };
  double best = 1e300;
  for (int a = 1; a <= kSteps; ++a) {
    for (int b = a; b <= kSteps; ++b) {
      for (int c = b; c <= kSteps; ++c) {
        for (int d = c; d <= kSteps; ++d) {
          if (at(d) < task.lowest_top) continue;
          best = std::min(best, score_levels(task, {0.0, at(a), at(b), at(c), at(d)}));
        }
      }
    }
  }
  EXPECT_LT(score_levels(task, place_levels(task, 5, 1)), 1.03 * best);
}

TEST(PlaceLevels, KeepTheirBounds) {
  PlacementTask task = task_of(bending_plate(), 4000.0);
  for (const bool vented : {true, false}) {
    task.vented = vented;
    for (const int repeats : {1, 2, 4}) {
      task.most_repeats = repeats;
      const auto levels = tidy_levels(task, place_levels(task, 12, 1));
      EXPECT_TRUE(std::is_sorted(levels.begin(), levels.end()));
      EXPECT_EQ(levels.front() == 0.0, vented);
      EXPECT_GE(levels.back(), task.lowest_top);
      EXPECT_LE(levels.back(), task.highest_level);
      for (const PlannedLevel& level : count_repeats(levels)) EXPECT_LE(level.repeats, repeats);
    }
  }
}

TEST(PlaceLevels, AreTheSameOnAnyNumberOfThreads) {
  const PlacementTask task = task_of(bowed_membrane(), 17500.0);
  EXPECT_EQ(place_levels(task, 9, 1), place_levels(task, 9, 3));
}

TEST(PlaceLevels, ForADoubtfulWallServeItsNeighboursToo) {
  PlacementTask sure = task_of(bowed_membrane(), 17500.0);
  sure.aim = Aim::worst;
  PlacementTask doubtful = sure;
  doubtful.wall_doubt = 0.1;
  const auto sharp = place_levels(sure, 14, 1), safe = place_levels(doubtful, 14, 1);
  const auto worst_of = [&](const std::vector<double>& levels) {
    double worst = 0.0;
    for (const double factor : {0.9, 1.1}) {
      Apparatus other = sure.apparatus;
      other.curve = sure.apparatus.curve.scaled(factor);
      worst = std::max(worst, uncertainty_over(other, levels, sure.target).worst);
    }
    return worst;
  };
  EXPECT_LT(worst_of(safe), worst_of(sharp));
}

TEST(PlaceLevels, StopWhenAsked) {
  Monitor monitor;
  monitor.stop_requested = [] { return true; };
  EXPECT_THROW(place_levels(task_of(bending_plate(), 4000.0), 8, 1, monitor), Interrupted);
}

TEST(TidyLevels, CostNextToNothing) {
  const PlacementTask task = task_of(bowed_membrane(), 17500.0);
  const auto placed = place_levels(task, 12, 1), tidy = tidy_levels(task, placed);
  EXPECT_LE(score_levels(task, tidy), 1.021 * score_levels(task, placed));
  for (const double level : tidy) EXPECT_EQ(level, std::round(level));
}

TEST(FewestLevels, AreEnoughAndOneLessIsNot) {
  PlacementTask task = task_of(bending_plate(), 4000.0);
  task.aim = Aim::worst;
  const auto enough = [&](const std::vector<double>& levels) {
    return uncertainty_over(task.apparatus, levels, task.target).worst <= 7.0;
  };
  const ChosenLevels chosen = fewest_levels(task, 30, enough, 1);
  ASSERT_TRUE(chosen.enough);
  EXPECT_TRUE(enough(chosen.levels));
  const int n = static_cast<int>(chosen.levels.size());
  EXPECT_FALSE(enough(tidy_levels(task, place_levels(task, n - 1, 1))));
  const ChosenLevels few = fewest_levels(task, 6, enough, 1);
  EXPECT_FALSE(few.enough);
  EXPECT_EQ(few.levels.size(), 6u);
}

TEST(Target, WeighsPressuresByWhereRunsHaveThem) {
  const Target target{{0.0, 10.0}, {{0.0, 10.0}, {0.0, 2.0}}};
  EXPECT_DOUBLE_EQ(target.density(1.0), 0.5 * (0.1 + 0.5));
  EXPECT_DOUBLE_EQ(target.density(5.0), 0.05);
  EXPECT_DOUBLE_EQ((Target{{2.0, 4.0}, {}}).density(3.0), 0.5);
}

}  // namespace
}  // namespace manoscope::design
