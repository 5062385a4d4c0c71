// The short form of the coverage campaign: a dozen experiments with walls that do not ship.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "manoscope/core/parallel.hpp"
#include "tests/campaign/member.hpp"
#include "tests/campaign/varied_scenario.hpp"
#include "tests/support/temporary_folder.hpp"

namespace manoscope::campaign {
namespace {

/// The wall of another laboratory, seen by a camera and at flow rates that make a quick experiment.
twin::Scenario small_varied(const std::string& base) {
  twin::Scenario scenario = varied_scenario(base, 1);
  scenario.camera = twin::resized(scenario.camera, "512x96");
  scenario.flow_rates = {scenario.flow_rates[1], scenario.flow_rates[3]};
  return scenario;
}

TEST(Coverage, OfWallsThatDoNotShipIsFairAndErrorsAreSmall) {
  constexpr std::uint64_t kSeeds = 4;
  double covered = 0.0, squares = 0.0, n = 0.0;
  for (const char* base : {"S2", "S4"}) {
    const twin::Scenario scenario = small_varied(base);
    const twin::SolvedScenario solved = twin::solve_scenario(scenario);
    const test_support::TemporaryFolder scratch;
    std::vector<MeasuredMember> members(kSeeds);
    parallel_for(kSeeds, 0, [&](Index i) {
      const Member member{base, 1, 100 + static_cast<std::uint64_t>(i)};
      members[static_cast<std::size_t>(i)] =
          measure_member(member, scenario, solved, scratch.path());
    });
    for (const MeasuredMember& member : members) {
      for (Index run = 0; run < member.measurement.flow_rate.size(); ++run) {
        const auto judged = judge_stretch(member, run, kStretches[0]);
        ASSERT_GT(judged.n_answered, 0) << base;
        // Labels of 3 and 10 Pa, and the pixels of a camera half as fine.
        EXPECT_LT(judged.rms, 20.0) << base << ' ' << run;
        covered += judged.coverage;
        squares += judged.pull_rms * judged.pull_rms;
        n += 1.0;
      }
    }
  }
  // Eight experiments whose runs share their labels: as many pulls that count, so that their mean
  // square scatters by 1/2 about 1 and is below 2.5 but for one in 400 such tests (chi-square, 8).
  EXPECT_LT(squares / n, 2.5);
  EXPECT_GT(squares / n, 0.2);
  EXPECT_GT(covered / n, 0.75);
}

TEST(VariedScenario, IsTheShippedOneAtZeroAndTheSameForTheSameNumber) {
  const twin::Scenario shipped = varied_scenario("S5", 0), one = varied_scenario("S5", 1);
  EXPECT_NE(one.wall.youngs_modulus, shipped.wall.youngs_modulus);
  EXPECT_EQ(one.wall.youngs_modulus, varied_scenario("S5", 1).wall.youngs_modulus);
  EXPECT_TRUE(std::is_sorted(one.levels.begin(), one.levels.end()));
  for (std::uint64_t number = 0; number < 30; ++number) {
    for (const char* base : {"S1", "S2", "S3", "S4", "S5", "S1b"}) {
      EXPECT_NO_THROW(varied_scenario(base, number).validate()) << base << number;
    }
  }
}

TEST(Members, ShareNoRandomNumbers) {
  EXPECT_NE((Member{"S1", 0, 1}.own_seed()), (Member{"S2", 0, 1}.own_seed()));
  EXPECT_NE((Member{"S1", 0, 1}.own_seed()), (Member{"S1", 1, 1}.own_seed()));
  EXPECT_NE((Member{"S1", 0, 1}.own_seed()), (Member{"S1", 0, 2}.own_seed()));
}

}  // namespace
}  // namespace manoscope::campaign
