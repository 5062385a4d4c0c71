// An origin in the experiment file that is not the wall's: whatever it does to the reading, it is
// said.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include "manoscope/pipeline/test_experiment.hpp"

namespace manoscope::pipeline {
namespace {

/// A camera that shows much of the frame, so that a channel 2 mm off still lies in the map.
TestExperiment wide_experiment() {
  twin::Scenario scenario = small_scenario();
  scenario.camera.rim = 2.5 * mm;
  scenario.camera.n_along = 640;  // 32 um: the ends of the wall are seen to a tenth of it
  scenario.camera.n_across = 128;
  return TestExperiment(scenario);
}

/// Warnings of the measurement, or what it was refused with.
std::string told_of(const std::string& original, TestExperiment& test, double along_mm,
                    double across_mm) {
  const double origin_mm = test.scenario.camera.rim.in(mm);
  test.twin.experiment_toml = original;
  test.remove_line("origin = ");
  test.replace("[channel]\n", fmt::format("[channel]\norigin = [\"{} mm\", \"{} mm\"]\n",
                                          origin_mm + along_mm, origin_mm + across_mm));
  try {
    return all_warnings(test.measure());
  } catch (const InputError& error) {
    return error.what();
  }
}

TEST(Origin, ThatIsWrongIsSaidHoweverFar) {
  TestExperiment test = wide_experiment();
  const std::string original = test.twin.experiment_toml;
  EXPECT_EQ(told_of(original, test, 0.0, 0.0).find("channel.origin"), std::string::npos);
  for (const double off : {0.1, -0.1, 0.5, 2.0}) {
    const std::string along = told_of(original, test, off, 0.0);
    EXPECT_NE(along.find("channel.origin"), std::string::npos) << off << " along: " << along;
    // The wall lies to the other side of a frame that is off to one.
    EXPECT_NE(along.find(off > 0.0 ? "upstream" : "downstream"), std::string::npos) << along;
    const std::string across = told_of(original, test, 0.0, off);
    EXPECT_NE(across.find("channel.origin"), std::string::npos) << off << " across: " << across;
  }
  const std::string beyond = told_of(original, test, 5.0, 0.0);
  EXPECT_NE(beyond.find("Check channel.origin"), std::string::npos) << beyond;
}

}  // namespace
}  // namespace manoscope::pipeline
