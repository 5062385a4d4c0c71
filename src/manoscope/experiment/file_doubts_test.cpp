#include "manoscope/experiment/file_doubts.hpp"

#include <gtest/gtest.h>

#include <optional>

namespace manoscope::experiment {
namespace {

/// Five maps at rest, the first vented, the others with an uncertainty; one under flow.
Experiment sound() {
  Experiment experiment;
  experiment.channel.height_uncertainty = 0.5 * um;
  for (int k = 0; k < 5; ++k) {
    HydrostaticMap map;
    map.pressure = 100.0 * k * Pa;
    map.pressure_uncertainty = k == 0 ? Pressure{} : 10.0 * Pa;
    map.vented = k == 0;
    experiment.hydrostatic.push_back(map);
  }
  experiment.flow.resize(1);
  return experiment;
}

/// The one doubt there should be.
std::string only(const Experiment& experiment) {
  const auto doubts = file_doubts(experiment);
  EXPECT_EQ(doubts.size(), 1u);
  return doubts.empty() ? "" : doubts.front();
}

void expect_says(const std::string& text, const std::string& part) {
  EXPECT_NE(text.find(part), std::string::npos) << text;
}

TEST(FileDoubts, AreNoneOfASoundFile) {
  EXPECT_TRUE(file_doubts(sound()).empty());
  EXPECT_TRUE(file_doubts(Experiment{}).empty());
}

TEST(FileDoubts, OfLabelsWithoutUncertaintyAreOneAndNameBothMends) {
  Experiment test = sound();
  for (auto& map : test.hydrostatic) {
    if (!map.vented) map.pressure_uncertainty.reset();
  }
  const std::string doubt = only(test);
  expect_says(doubt, "No pressure label has an uncertainty");
  expect_says(doubt, "instrument.pressure_noise");
  expect_says(doubt, "column pressure_uncertainty");
  EXPECT_EQ(doubt.find("vented"), std::string::npos) << doubt;
  // A map at 0 Pa of which nobody says that it was vented was read on the gauge, too.
  test.hydrostatic[0].pressure_uncertainty.reset();
  test.hydrostatic[0].vented = false;
  expect_says(only(test), "No pressure label has an uncertainty");
}

TEST(FileDoubts, OfSomeLabelsWithoutUncertaintyCountThem) {
  Experiment test = sound();
  test.hydrostatic[2].pressure_uncertainty.reset();
  test.hydrostatic[4].pressure_uncertainty.reset();
  expect_says(only(test), "2 of 4 pressure labels have no uncertainty");
}

TEST(FileDoubts, OfAGaugeClaimedExactSayThatItIsStated) {
  Experiment test = sound();
  for (int k = 1; k < 5; ++k)
    test.hydrostatic[static_cast<std::size_t>(k)].pressure_uncertainty = Pressure{};
  expect_says(only(test),
              "4 of 4 pressure labels read on the gauge have a stated uncertainty of 0");
}

TEST(FileDoubts, OfTheGapNeedAMapUnderFlow) {
  Experiment test = sound();
  test.channel.height_uncertainty.reset();
  expect_says(only(test), "channel.height_uncertainty");
  test.flow.clear();
  EXPECT_TRUE(file_doubts(test).empty());
}

}  // namespace
}  // namespace manoscope::experiment
