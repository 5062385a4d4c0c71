#include "manoscope/experiment/rigid_section.hpp"

#include <gtest/gtest.h>

#include "manoscope/core/error.hpp"
#include "manoscope/experiment/test_folder.hpp"

namespace manoscope::experiment {
namespace {

constexpr const char* kSimulated =
    "simulated = [\n"
    "  {flow_rate = \"20 mL/min\", drop = \"310 Pa\", uncertainty = \"10 Pa\"},\n"
    "  {flow_rate = \"70 mL/min\", drop = \"1.4 kPa\"}]\n";

/// Section [rigid] of the full example with one replacement.
RigidSection rigid_with(const char* from, const char* to) {
  const TestFolder folder;
  write_full_example(folder);
  folder.write("experiment.toml", replaced(kFullToml, from, to));
  return read_experiment(folder.path()).rigid;
}

TEST(RigidSection, TakesAStepToASectionOfThePassagesOwnSizeInAnyUnit) {
  // In binary some of these areas are below 1.7 mm times 250 um, by round-off.
  for (const char* area : {"0.425 mm2", "425000 um2", "4.25e-3 cm2", "4.25e-7 m2"}) {
    const std::string outlet = std::string("height = \"250 um\", from = \"") + area + "\"";
    const auto rigid = rigid_with(
        "height = \"175 um\", height_uncertainty = \"0.6 um\", from = \"1 mm2\"", outlet.c_str());
    const Passage& passage = *rigid.outlet;
    // The formulas refuse a section below the passage's, so that no round-off may be left.
    EXPECT_GE(*passage.fittings.from, passage.width * passage.height) << area;
    EXPECT_NO_THROW(flow::passage_terms({1.0 * mPa_s, 998.0 * kg_per_m3}, 20.0 * mL_per_min,
                                        {passage.length, passage.width, passage.height},
                                        passage.fittings))
        << area;
  }
}

TEST(RigidSection, TakesAReservoirThatIsDeniedBesideASection) {
  const auto rigid = rigid_with("from = \"1 mm2\"", "from = \"1 mm2\", from_reservoir = false");
  EXPECT_TRUE(rigid.outlet->fittings.from);
  EXPECT_FALSE(rigid.outlet->fittings.from_reservoir);
}

TEST(RigidSection, KnowsNeitherStepsNorBendsOfAPassageThatHasOnlySizes) {
  const auto rigid = rigid_with(", from = \"1 mm2\", into_reservoir = true, mitre_bends = 1", "");
  const flow::PassageFittings& fittings = rigid.outlet->fittings;
  EXPECT_FALSE(fittings.from || fittings.into || fittings.from_reservoir ||
               fittings.into_reservoir);
  EXPECT_EQ(fittings.round_bends + fittings.mitre_bends, 0);
}

TEST(RigidSection, LeavesSimulationsBelowTheLargestFlowRateToTheMeasurement) {
  const auto rigid = rigid_with("70 mL/min", "30 mL/min");  // the runs go to 70 mL/min
  ASSERT_EQ(rigid.simulated.size(), 2u);
  EXPECT_NEAR(rigid.simulated[1].flow_rate.in(mL_per_min), 30.0, 1e-12);  // round-off
}

TEST(RigidSection, TakesSimulationsAsSectionsOfTheirOwn) {
  const auto rigid =
      rigid_with(kSimulated,
                 "[[rigid.simulated]]\nflow_rate = \"70 mL/min\"\ndrop = \"1 kPa\"\n"
                 "[[rigid.simulated]]\nflow_rate = \"5 mL/min\"\ndrop = \"50 Pa\"\n");
  ASSERT_EQ(rigid.simulated.size(), 2u);
  EXPECT_EQ(rigid.simulated[0].drop, 1.0 * kPa);
  EXPECT_EQ(rigid.simulated[1].drop, 50.0 * Pa);
}

TEST(RigidSection, TakesSimulationsWithoutTheSizesOfThePassages) {
  const TestFolder folder;
  write_full_example(folder);
  const std::string text = kFullToml;
  const auto begin = text.find("inlet  = {"), end = text.find("simulated");
  folder.write("experiment.toml", text.substr(0, begin) + text.substr(end));
  const RigidSection rigid = read_experiment(folder.path()).rigid;
  EXPECT_FALSE(rigid.inlet || rigid.outlet);
  EXPECT_EQ(rigid.simulated.size(), 2u);
}

}  // namespace
}  // namespace manoscope::experiment
