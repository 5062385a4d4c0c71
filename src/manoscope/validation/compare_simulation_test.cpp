#include "manoscope/validation/compare_simulation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "manoscope/flow/plane_march.hpp"
#include "manoscope/validation/test_coupled_trial.hpp"

namespace manoscope::validation {
namespace {

constexpr Index kSolved = 311;

/// In place of a solver: creeping flow in a rectangular duct of the smooth wall, or between plates.
SolvedPressure solved(const SmoothShape& shape, const flow::Channel& channel, bool plane = false) {
  SolvedPressure result;
  result.plane = plane;
  result.x = Array1::LinSpaced(kSolved, 0.0, channel.length.si());
  const Array1 gap = channel.height.si() + shape.zeta(result.x);
  result.pressure = Array1::Zero(kSolved);
  const auto fall = [&](double h) {
    const double w = channel.width.si(), eta = kOil.viscosity.si();
    return kOilFlow.si() * (plane ? 12.0 * eta / (w * h * h * h) : series_resistance(eta, w, h));
  };
  for (Index i = kSolved - 1; i-- > 0;) {
    result.pressure[i] = result.pressure[i + 1] +
                         0.5 * (fall(gap[i]) + fall(gap[i + 1])) * (result.x[i + 1] - result.x[i]);
  }
  result.mesh = result.inlet = Array1::Zero(kSolved);
  return result;
}

struct Held {
  CoupledTrial trial;
  Profile state;
  inversion::PressureReading reading;
  explicit Held(CoupledTrial made) : trial(std::move(made)) {
    state = trial.state(trial.fine_pressure());
    reading = trial.reading(state);
  }
};

const Outlet kOutlet{600.0 * Pa, 40.0 * Pa};

TEST(CompareSimulation, BarsCoverTheDifferenceFromTheReading) {
  const FlowUncertainty stated{kHeightUncertainty, 0.003 * kOil.viscosity, 0.003};
  constexpr int kSeeds = 200;
  double squares = 0.0;
  int along = 0;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    CoupledTrial trial;
    trial.seed = static_cast<std::uint64_t>(seed) + 300;
    RandomStream truth(trial.seed, "truth");
    trial.channel.height = kChannel.height + truth.normal() * kHeightUncertainty;
    trial.fluid.viscosity = kOil.viscosity + truth.normal() * stated.viscosity;
    trial.flow_rate = (1.0 + 0.003 * truth.normal()) * kOilFlow;
    const Held held(trial);
    const SmoothShape shape(held.state, kChannel);
    const SimulationComparison found =
        compare_simulation(observed(kChannel, kOil, stated), kOilFlow, shape, held.state,
                           solved(shape, kChannel), kOutlet, held.reading, kSection);
    ASSERT_EQ(found.variants.size(), 1u);
    const ModelAgreement& drop = *found.variants[0].agreement;
    squares += std::pow(drop.difference / drop.uncertainty, 2) / kSeeds;
    along += drop.along.tail < 0.01 ? 1 : 0;
    EXPECT_NEAR(drop.en_number, std::abs(drop.difference) / (2.0 * drop.uncertainty), 1e-12);
  }
  // Mean square pull 1, known to sqrt(2/200) = 0.1; chance passes 0.01 in 2 of 200, 6 at most.
  EXPECT_NEAR(squares, 1.0, 0.3);
  EXPECT_LE(along, 6);
}

TEST(CompareSimulation, NamesEveryPartOfTheUncertainty) {
  const Held held{CoupledTrial{}};
  const SmoothShape shape(held.state, kChannel);
  const FlowUncertainty stated{kHeightUncertainty, 0.01 * kOil.viscosity, 0.02};
  SolvedPressure given = solved(shape, kChannel);
  given.mesh = 3.0 * (1.0 - given.x / kChannel.length.si());
  given.inlet = -20.0 * (1.0 - given.x / kChannel.length.si()).square();
  given.roof_across = 7.0 * (1.0 - given.x / kChannel.length.si());
  const SimulationComparison found =
      compare_simulation(observed(kChannel, kOil, stated), kOilFlow, shape, held.state, given,
                         kOutlet, held.reading, kSection);
  const Uncertainty& bars = found.variants[0].uncertainty;
  std::map<std::string, double> first;  // variance at the inlet by part
  for (const ErrorMode& mode : bars.modes) first[mode.source] += mode.effect[0] * mode.effect[0];
  const double drop = given.pressure[0];
  EXPECT_NEAR(std::sqrt(first.at("numerical")), 3.0, 1e-12);
  EXPECT_NEAR(std::sqrt(first.at("inlet profile")), 20.0, 1e-12);
  EXPECT_NEAR(std::sqrt(first.at("roof across")), 7.0, 1e-12);
  EXPECT_NEAR(std::sqrt(first.at("outlet pressure")), 40.0, 1e-12);
  // Creeping flow goes as eta and Q; what the plane march has of inertia is below 1 % here.
  EXPECT_NEAR(std::sqrt(first.at("viscosity")) / (0.01 * drop), 1.0, 0.02);
  EXPECT_NEAR(std::sqrt(first.at("flow rate")) / (0.02 * drop), 1.0, 0.02);
  // The stand-in once more in a channel that is higher by the uncertainty.
  flow::Channel higher = kChannel;
  higher.height = kChannel.height + kHeightUncertainty;
  const double moved = drop - solved(shape, higher).pressure[0];
  EXPECT_NEAR(std::sqrt(first.at("channel height")) / moved, 1.0, 0.02);
  EXPECT_GT(first.at("deflection"), 0.0);
  for (const auto& [name, variance] : first) {
    EXPECT_NE(std::find(std::begin(kSimulationErrors), std::end(kSimulationErrors), name),
              std::end(kSimulationErrors))
        << name;
  }
  // In the drop the outlet cancels.
  for (const Estimate::Term& term : found.variants[0].agreement->drop.terms) {
    if (term.source == "outlet pressure") {
      EXPECT_NEAR(term.effect, 0.0, 1e-9);
    }
  }
  EXPECT_EQ(found.variants[0].pressure[kSolved - 1], 600.0);
}

TEST(CompareSimulation, AnInletExcusesADifferenceOneWayOnly) {
  const Held held{CoupledTrial{}};
  const SmoothShape shape(held.state, kChannel);
  const auto bar = [&](double pressure, double inlet) {
    SolvedPressure given = solved(shape, kChannel);
    given.pressure *= pressure;
    given.inlet = inlet * given.pressure;
    return compare_simulation(observed(kChannel, kOil), kOilFlow, shape, held.state, given, kOutlet,
                              held.reading, kSection)
        .variants[0]
        .agreement->uncertainty;
  };
  // A drop 5 % too small, and a profile that may add another 5 %, or take them off.
  EXPECT_GT(bar(0.95, 0.05), 2.0 * bar(0.95, 0.0));
  EXPECT_DOUBLE_EQ(bar(0.95, -0.05), bar(0.95, 0.0));
  EXPECT_DOUBLE_EQ(bar(1.05, 0.05), bar(1.05, 0.0));
}

TEST(CompareSimulation, GivesWhatSideWallsAddBesideAPlaneSolution) {
  const Held held{CoupledTrial{}};
  const SmoothShape shape(held.state, kChannel);
  const SolvedPressure plane = solved(shape, kChannel, true), duct = solved(shape, kChannel);
  const SimulationComparison found =
      compare_simulation(observed(kChannel, kOil), kOilFlow, shape, held.state, plane, kOutlet,
                         held.reading, kSection);
  ASSERT_EQ(found.variants.size(), 2u);
  const auto& as_solved = found.variants[0];
  const auto& whole = found.variants[1];
  EXPECT_EQ(as_solved.name, "as solved");
  EXPECT_LT((as_solved.pressure - plane.pressure - 600.0).abs().maxCoeff(), 1e-9);
  // A duct by its series, 0.63 h/w more than the plates; tables are good to 1e-8.
  EXPECT_LT((whole.pressure - duct.pressure - 600.0).abs().maxCoeff(), 1e-6 * duct.pressure[0]);
  EXPECT_EQ(as_solved.agreement->agreement, Agreement::differ);
  EXPECT_NE(as_solved.agreement->words.find("the simulation gives"), std::string::npos);
  EXPECT_EQ(whole.agreement->agreement, Agreement::agree) << whole.agreement->words;
  double sides = 0.0;
  for (const ErrorMode& mode : whole.uncertainty.modes) {
    if (mode.source == "side walls") sides = mode.effect[0];
  }
  // Re h/l = 0.06: creeping.
  EXPECT_NEAR(sides / (0.005 * (duct.pressure[0] - plane.pressure[0])), 1.0, 1e-5);
  for (const ErrorMode& mode : as_solved.uncertainty.modes) EXPECT_NE(mode.source, "side walls");
}

/// A wall of a mean deflection, m, that falls to a share of it along the channel, and flow below
/// it.
struct BulgedChannel {
  flow::Channel channel;
  double bulge, at_end;
  std::vector<double> rates;  ///< mL/min
};

TEST(CompareSimulation, SideWallsHoldWithinTheirStatedErrorOfTheMarchOnSections) {
  // Sizes of S1, S4 and S5 at their flow rates; the plane march in place of a plane solution.
  for (const BulgedChannel& one :
       {BulgedChannel{kChannel, 33e-6, 0.4, {5.0, 20.0, 40.0, 70.0}},
        {{15.5 * mm, 1.7 * mm, 244.0 * um}, 20e-6, 0.3, {11.5, 50.0}},
        {{15.5 * mm, 1.7 * mm, 244.0 * um}, 60e-6, 0.3, {11.5, 25.0, 50.0}},
        {{15.5 * mm, 1.7 * mm, 155.0 * um}, 20e-6, 0.3, {11.0, 50.0}},
        {{15.5 * mm, 1.7 * mm, 155.0 * um}, 40e-6, 0.3, {11.0, 25.0, 50.0}}}) {
    const Index n = 400;
    const double l = one.channel.length.si(), rise = 0.54e-3;
    const Array1 x = Array1::LinSpaced(n, 0.0, l);
    const Array1 zeta = one.bulge * (1.0 - (1.0 - one.at_end) * x / l) * (1.0 - (-x / rise).exp()) *
                        (1.0 - ((x - l) / rise).exp());
    FlowSetup setup;
    setup.channel = one.channel;
    setup.fluid = kWater;
    flow::FlowCase flow;
    flow.channel = one.channel;
    flow.fluid = kWater;
    flow.x = x;
    flow.zeta = zeta;
    // The ends' layers left out, as a test section does.
    const Index first = n / 9, last = n - n / 9;
    for (const double rate : one.rates) {
      flow.flow_rate = rate * mL_per_min;
      const Array1 plane = flow::march_plane(x, one.channel.height.si() + zeta, Array1::Ones(n),
                                             flow.flow_rate.si() / one.channel.width.si(), kWater)
                               .pressure;
      const Array1 exact = flow::pressure_along(flow::FlowModel::section_march, flow).pressure;
      const Array1 sides = side_wall_pressure(setup, flow.flow_rate, x, zeta);
      const auto drop = [&](const Array1& p) { return p[first] - p[last]; };
      const double error = drop(plane) + drop(sides) - drop(exact);
      EXPECT_LT(std::abs(error), 2.0 * side_wall_error(setup, flow.flow_rate, zeta) * drop(sides))
          << rate << " mL/min: " << error << " Pa of " << drop(sides);
    }
  }
}

TEST(CompareSimulation, GivesNoVerdictWithoutSectionOrGap) {
  const Held held{CoupledTrial{}};
  const SmoothShape shape(held.state, kChannel);
  const SolvedPressure given = solved(shape, kChannel);
  const auto without = compare_simulation(observed(kChannel, kOil), kOilFlow, shape, held.state,
                                          given, kOutlet, held.reading, std::nullopt);
  EXPECT_FALSE(without.variants[0].agreement);
  EXPECT_FALSE(without.extracted);
  const auto exact = compare_simulation(observed(kChannel, kOil, {}), kOilFlow, shape, held.state,
                                        given, kOutlet, held.reading, kSection);
  EXPECT_TRUE(std::isnan(exact.variants[0].agreement->en_number));
  EXPECT_EQ(exact.variants[0].agreement->agreement, Agreement::no_verdict);
}

}  // namespace
}  // namespace manoscope::validation
