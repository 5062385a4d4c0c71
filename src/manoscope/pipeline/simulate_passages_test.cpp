// Drops of rigid passages, by a stand-in for the solver.
#include "manoscope/pipeline/simulate_passages.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "manoscope/core/error.hpp"
#include "manoscope/experiment/test_folder.hpp"
#include "manoscope/pipeline/flow_knowledge.hpp"

namespace manoscope::pipeline {
namespace {

constexpr const char* kInlet =
    "inlet  = {length = \"5 mm\", width = \"1.7 mm\", height = \"350 um\", height_uncertainty = "
    "\"1 um\", ";
constexpr const char* kOutlet =
    "outlet = {length = \"4 mm\", width = \"1.7 mm\", height = \"175 um\"}\n";

/// The full example with passages of its own.
experiment::Experiment with_passages(const experiment::TestFolder& folder,
                                     const std::string& rigid) {
  experiment::write_full_example(folder);
  const std::string text = experiment::kFullToml;
  const auto at = text.find("[rigid]");
  folder.write("experiment.toml", text.substr(0, at) + "[rigid]\n" + rigid);
  return experiment::read_experiment(folder.path());
}

/// A drop that goes as a Q + b Q^2, uncertain by a percent.
SolvedPassage stand_in(const GivenPassage& given) {
  const double q = given.flow_rate.in(mL_per_min);
  SolvedPassage solved;
  solved.drop = (given.is_inlet ? 5.0 : 10.0) * q + 0.1 * q * q;
  solved.drop_uncertainty = 0.01 * solved.drop;
  solved.converged = true;
  solved.n_unknowns = 1.0;
  return solved;
}

TEST(SimulatePassages, TellTheSolverWhatStandsInTheExperimentFile) {
  const experiment::TestFolder folder;
  const auto e = with_passages(
      folder, std::string(kInlet) + "port = \"1 mm\", port_side = \"side\"}\n" +
                  "outlet = {length = \"4 mm\", width = \"1.7 mm\", height = \"175 um\", from = "
                  "\"0.2975 mm2\", into = \"1.19 mm2\"}\n");
  std::vector<GivenPassage> asked;
  simulate_passages(e, {20.0 * mL_per_min}, [&](const GivenPassage& given) {
    asked.push_back(given);
    return stand_in(given);
  });
  ASSERT_EQ(asked.size(), 2u);
  EXPECT_TRUE(asked[0].is_inlet);
  EXPECT_EQ(asked[0].channel, channel_of(e));
  EXPECT_EQ(asked[0].fluid, fluid_of(e));
  EXPECT_EQ(asked[0].passage.height, 350.0 * um);
  EXPECT_EQ(asked[0].port, 1.0 * mm);
  EXPECT_TRUE(asked[0].port_at_side);
  EXPECT_EQ(asked[0].beyond_width, Length{});
  EXPECT_FALSE(asked[1].is_inlet);
  EXPECT_EQ(asked[1].port, Length{});
  // Four times its own section: twice as wide and as high.
  EXPECT_NEAR(asked[1].beyond_width.in(mm), 3.4, 1e-9);
  EXPECT_NEAR(asked[1].beyond_height.in(um), 350.0, 1e-6);
}

TEST(SimulatePassages, GiveTheMeasurementWhatTheyFound) {
  const experiment::TestFolder folder;
  const std::string rigid = std::string(kInlet) + "round_bends = 1}\n" + kOutlet;
  const auto e = with_passages(folder, rigid);
  const auto drops = simulate_passages(e, {20.0 * mL_per_min, 70.0 * mL_per_min}, stand_in);
  ASSERT_EQ(drops.size(), 2u);
  EXPECT_DOUBLE_EQ(drops[0].drop(), 140.0 + 240.0 + drops[0].bends);
  EXPECT_GT(drops[0].bends, 0.0);
  // A micrometre of 350: about -3 dh/h of the duct's drop by formula, and -2 dh/h of the bend's.
  EXPECT_LT(drops[0].height_effect, 0.0);
  EXPECT_NEAR(drops[0].uncertainty(),
              std::hypot(3.8, drops[0].bends_uncertainty, drops[0].height_effect), 1e-9);
  const auto again = with_passages(folder, rigid + simulated_key(drops));
  for (const ParasiticDrop& drop : drops) {
    const auto terms = passages(again, drop.flow_rate);
    ASSERT_EQ(terms.size(), 1u);
    EXPECT_EQ(terms[0].formula, "simulation");
    // Two simulations and two unknowns: the fit goes through both, to the six digits written.
    EXPECT_NEAR(terms[0].drop.si() / drop.drop(), 1.0, 1e-5);
    EXPECT_NEAR(terms[0].uncertainty.si() / drop.uncertainty(), 1.0, 1e-5);
  }
}

TEST(SimulatePassages, CountAPortAsTheBendThatItIs) {
  const experiment::TestFolder folder;
  const auto e = with_passages(folder, std::string(kInlet) + "port = \"1 mm\"}\n");
  const auto drop = simulate_passages(e, {20.0 * mL_per_min}, stand_in).front();
  EXPECT_EQ(drop.bends, 0.0);  // it is in the mesh
  EXPECT_EQ(drop.outlet.drop, 0.0);
  bool bend = false;
  for (const auto& term : passages(e, 20.0 * mL_per_min)) {
    bend = bend || term.name == "inlet, mitre bends";
  }
  EXPECT_TRUE(bend);
  const auto doubts = passage_doubts(e, {drop});
  ASSERT_EQ(doubts.size(), 1u);
  EXPECT_NE(doubts[0].find("one flow rate"), std::string::npos);
}

TEST(SimulatePassages, RefuseWhatTheyCannotBuild) {
  const experiment::TestFolder folder;
  const auto refusal = [&](const std::string& rigid) {
    try {
      simulate_passages(with_passages(folder, rigid), {20.0 * mL_per_min}, stand_in);
    } catch (const InputError& error) {
      return error.where() + ": " + error.found();
    }
    return std::string();
  };
  EXPECT_NE(
      refusal(std::string(kInlet) + "into = \"2 mm2\"}\n").find("rigid.inlet.into: a section"),
      std::string::npos);
  EXPECT_NE(refusal(std::string(kInlet) + "into_reservoir = true}\n").find("into_reservoir"),
            std::string::npos);
  EXPECT_NE(refusal("").find("neither rigid.inlet"), std::string::npos);
}

TEST(SimulatePassages, TakeEveryFlowRateOnce) {
  const experiment::TestFolder folder;
  auto e = with_passages(folder, kOutlet);
  ASSERT_FALSE(e.flow.empty());
  e.flow.push_back(e.flow.front());
  const auto rates = flow_rates_of(e, {"all"});
  for (std::size_t i = 1; i < rates.size(); ++i) EXPECT_GT(rates[i], rates[i - 1]);
  EXPECT_EQ(flow_rates_of(e, {e.flow.front().run}).size(), 1u);
  EXPECT_THROW(flow_rates_of(e, {"nothing"}), InputError);
  e.flow.front().flow_rate = FlowRate{};
  EXPECT_THROW(flow_rates_of(e, {"all"}), InputError);
}

}  // namespace
}  // namespace manoscope::pipeline
