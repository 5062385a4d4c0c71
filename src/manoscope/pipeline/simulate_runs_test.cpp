// Simulations of the runs of a virtual experiment, by a stand-in for the solver.
#include "manoscope/pipeline/simulate_runs.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "manoscope/core/error.hpp"
#include "manoscope/flow/plane_march.hpp"
#include "manoscope/pipeline/measure.hpp"
#include "manoscope/pipeline/test_experiment.hpp"
#include "manoscope/twin/solved_scenario.hpp"
#include "manoscope/validation/smooth_shape.hpp"

namespace manoscope::pipeline {
namespace {

using flow::InletProfile;
using results::Simulation;

/// A uniform inlet costs this share of the drop more.
constexpr double kEntry = 0.1;

/// Momentum integral on the true section, or, in the plane, the march without side walls; with a
/// numerical error of one pascal at the inlet.
SolvedFlow stand_in(const GivenFlow& given) {
  SolvedFlow solved;
  if (given.dim == 3) {
    flow::FlowCase flow;
    flow.channel = given.channel;
    flow.fluid = given.fluid;
    flow.flow_rate = given.flow_rate;
    flow.x = given.x;
    flow.zeta = given.zeta;
    flow.shape = given.wall_shape;
    solved.mean_pressure = flow::pressure_along(flow::FlowModel::momentum, flow).pressure;
  } else {
    solved.mean_pressure =
        flow::march_plane(given.x, given.channel.height.si() + given.zeta,
                          Array1::Ones(given.x.size()),
                          given.flow_rate.si() / given.channel.width.si(), given.fluid)
            .pressure;
  }
  if (given.inlet == InletProfile::uniform) solved.mean_pressure *= 1.0 + kEntry;
  const Array1 share = 1.0 - given.x / given.channel.length.si();
  solved.x = given.x;
  solved.gap = given.channel.height.si() + given.zeta;
  solved.coarse_mean_pressure = solved.mean_pressure - 0.5 * share;
  solved.mean_pressure_uncertainty = share;
  solved.wall_pressure = solved.floor_pressure = solved.mean_pressure;
  solved.wall_shear = solved.floor_shear = Array1::Ones(given.x.size());
  solved.drop = solved.mean_pressure[0];
  solved.drop_uncertainty = 1.0;
  solved.coarse_drop = solved.coarse_mean_pressure[0];
  solved.converged = true;
  return solved;
}

/// Keeps what was asked.
struct Asked {
  std::vector<GivenFlow> flows;
  FlowSolver solver() {
    return [this](const GivenFlow& given) {
      flows.push_back(given);
      return stand_in(given);
    };
  }
};

class SimulateRuns : public ::testing::Test {
 protected:
  static experiment::Experiment& experiment() {
    static TestExperiment test(momentum_scenario({10.0 * mL_per_min, 40.0 * mL_per_min}));
    static experiment::Experiment once = test.read();
    return once;
  }
  static const ReadyRuns& ready() {
    static const ReadyRuns once = ready_runs(experiment(), {"all"}, station_by_station(), 1, {});
    return once;
  }
  static Simulation simulate(std::size_t run, const SimulateOptions& options,
                             const FlowSolver& solver = stand_in) {
    return simulate_run(experiment(), ready(), run, options, solver);
  }
  static experiment::Experiment with_spread(double spread) {
    experiment::Experiment changed = experiment();
    changed.inlet.spread = spread;
    return changed;
  }
};

TEST_F(SimulateRuns, AgreeWithReadingAndTruthWhereTheSolverIsTrue) {
  const twin::SolvedScenario truth =
      twin::solve_scenario(momentum_scenario({10.0 * mL_per_min, 40.0 * mL_per_min}));
  for (const std::size_t run : {0u, 1u}) {
    const Simulation s = simulate_run(with_spread(0.0), ready(), run, {3, "auto"}, stand_in);
    ASSERT_EQ(s.variant.size(), 1u);
    EXPECT_LE(s.en_number[0], 1.0) << s.verdict[0];
    EXPECT_EQ(s.verdict[0].rfind("agree within", 0), 0u) << s.verdict[0];
    const auto& flow = truth.runs[run].flow;
    const Array1 error = s.pressure.row(0).transpose() - flow.pressure(s.x);
    const Array1 bar = s.pressure_uncertainty.row(0).transpose();
    // One draw of the gap, the flow rate and so on: three standard uncertainties.
    for (Index i = 0; i < error.size(); ++i) {
      EXPECT_LT(std::abs(error[i]), 3.0 * bar[i] + 1e-3 * s.channel_drop) << s.x[i];
    }
    // What is left of the wall's error is that of the profile (plane and place of the map), less
    // noise: smoothing adds none of its own.
    const Profile& raw = ready().calibration.runs[run].profile;
    const validation::SmoothShape shape(raw, channel_of(experiment()));
    double smooth_square = 0.0, raw_square = 0.0;
    for (Index ix = 0; ix < raw.x.size(); ++ix) {
      if (raw.flags[ix] != 0 || raw.x[ix] < 0.0 || raw.x[ix] > s.x[s.x.size() - 1]) continue;
      const double exact = flow.deflection(raw.x.segment(ix, 1))[0];
      smooth_square += std::pow(shape.zeta(raw.x.segment(ix, 1))[0] - exact, 2);
      raw_square += std::pow(raw.zeta[ix] - exact, 2);
    }
    EXPECT_LT(smooth_square, 1.02 * raw_square);
    EXPECT_LT(s.smoothing_taken, 1.2 * s.smoothing_noise);
    EXPECT_GE(s.smoothing_half_wavelength, 2.0 * experiment().channel.height.si());
  }
}

TEST_F(SimulateRuns, HoldTheReadingThatMeasureGives) {
  const results::Measurement measured = measure(experiment(), station_by_station(), 1);
  const Simulation s = simulate(1, {3, "developed"});
  EXPECT_EQ(s.extracted_drop, measured.extracted_drop[1]);
  EXPECT_EQ(s.inputs, measured.inputs);
  EXPECT_EQ(s.experiment, measured.experiment);
  EXPECT_EQ(s.section_start, measured.test_section(1, 0));
  EXPECT_EQ(s.section_end, measured.test_section(1, 1));
}

TEST_F(SimulateRuns, SolveBothEndsOfWhatIsPlausibleAtTheInlet) {
  Asked open, known, both, uniform;
  const Simulation spread = simulate_run(with_spread(0.5), ready(), 1, {3, "auto"}, open.solver());
  ASSERT_EQ(open.flows.size(), 2u);
  EXPECT_EQ(open.flows[0].inlet, InletProfile::developed);
  EXPECT_TRUE(open.flows[0].leading);
  EXPECT_EQ(open.flows[1].inlet, InletProfile::uniform);
  EXPECT_FALSE(open.flows[1].leading);
  // Half the way to a profile that costs a tenth more; a third of its square is the variance.
  const double change = 0.5 * kEntry * spread.channel_drop;
  EXPECT_NEAR(spread.inlet_effect[0] / change, 1.0, 1e-9);
  Index inlet = 0;
  while (spread.error_source[static_cast<std::size_t>(inlet)] != "inlet profile") ++inlet;
  EXPECT_NEAR(spread.pressure_variance[static_cast<std::size_t>(inlet)](0, 0),
              change * change / 3.0, 1e-9 * change * change);
  EXPECT_NE(spread.inlet.find("50 %"), std::string::npos) << spread.inlet;

  simulate_run(with_spread(0.0), ready(), 1, {3, "auto"}, known.solver());
  EXPECT_EQ(known.flows.size(), 1u);
  simulate_run(with_spread(0.0), ready(), 1, {3, "both"}, both.solver());
  EXPECT_EQ(both.flows.size(), 2u);
  const Simulation fixed =
      simulate_run(with_spread(0.5), ready(), 1, {3, "uniform"}, uniform.solver());
  ASSERT_EQ(uniform.flows.size(), 1u);
  EXPECT_EQ(uniform.flows[0].inlet, InletProfile::uniform);
  EXPECT_EQ(fixed.inlet_effect.abs().maxCoeff(), 0.0);
}

TEST_F(SimulateRuns, TellTheSolverTheChannelAndItsSmoothWall) {
  Asked asked;
  const Simulation s = simulate(0, {2, "developed"}, asked.solver());
  const GivenFlow& given = asked.flows.at(0);
  EXPECT_EQ(given.dim, 2);
  EXPECT_EQ(given.channel, channel_of(experiment()));
  EXPECT_EQ(given.fluid, fluid_of(experiment()));
  EXPECT_NEAR(given.flow_rate.in(mL_per_min), 10.0, 1e-9);
  EXPECT_EQ(given.x[0], 0.0);
  EXPECT_NEAR(given.x[given.x.size() - 1] / given.channel.length.si(), 1.0, 1e-15);
  // Clamped at both ends.
  EXPECT_LT(std::abs(given.zeta[0]), 1e-8);
  EXPECT_LT(std::abs(given.zeta[given.zeta.size() - 1]), 1e-8);
  // A plane solution is given with and without what side walls add.
  EXPECT_EQ(s.variant, (std::vector<std::string>{"as solved", "side walls added"}));
  EXPECT_GT(s.drop[1], 1.02 * s.drop[0]);
  EXPECT_LT(s.en_number[1], s.en_number[0]);
  // p(x) is a gauge pressure beside the reading.
  const Index last = s.x.size() - 1;
  EXPECT_DOUBLE_EQ(s.pressure(0, last), s.outlet_pressure);
  EXPECT_GT(s.outlet_pressure, 0.0);
  const Index middle = s.x.size() / 2;
  EXPECT_NEAR(s.read_pressure[middle] / s.pressure(1, middle), 1.0, 0.05);
}

TEST_F(SimulateRuns, InThreeDimensionsTellTheSolverTheMapOfTheRoof) {
  Asked map, one_shape, plane;
  const Simulation s = simulate(1, {3, "developed"}, map.solver());
  const GivenFlow& given = map.flows.at(0);
  ASSERT_EQ(given.roof.rows(), given.x.size());
  ASSERT_EQ(given.roof.cols(), given.z.size());
  EXPECT_EQ(given.z[0], 0.0);
  EXPECT_NEAR(given.z[given.z.size() - 1] / given.channel.width.si(), 0.5, 1e-15);
  EXPECT_LT(given.roof.rightCols(1).abs().maxCoeff(), 1e-15);
  // This wall is a parabola across everywhere, of the width average that the plane has.
  const Array1 across = 1.5 * (1.0 - (2.0 / given.channel.width.si() * given.z).square());
  const Array2 parabola = (given.zeta.matrix() * across.matrix().transpose()).array();
  EXPECT_LT(std::sqrt((given.roof - parabola).square().mean()), 1e-3 * given.zeta.maxCoeff());
  EXPECT_EQ(s.roof_map, 1.0);
  EXPECT_LT(s.roof_misfit, 1.3);
  EXPECT_LT(std::abs(s.roof_effect), 1e-3);
  // A wall that answers to p(x) alone ends in a step, which no smooth roof holds.
  EXPECT_LT(s.roof_taken, 2.0 * s.roof_noise);
  EXPECT_NE(s.roof.find("its own maps"), std::string::npos) << s.roof;
  const auto last = s.error_source.size() - 1;
  ASSERT_EQ(s.error_source[last], "roof across");
  EXPECT_GT(s.pressure_variance[last](0, 0), 0.0);
  EXPECT_LT(std::sqrt(s.pressure_variance[last](0, 0)), 1e-3 * s.channel_drop);

  SimulateOptions without{3, "developed"};
  without.roof = RoofChoice::response;
  const Simulation flat = simulate(1, without, one_shape.solver());
  EXPECT_EQ(one_shape.flows.at(0).z.size(), 0);
  EXPECT_EQ(flat.roof_map, 0.0);
  EXPECT_TRUE(std::isnan(flat.roof_taken));
  EXPECT_NE(flat.roof.find("crest"), std::string::npos) << flat.roof;
  EXPECT_EQ(flat.pressure_variance[last](0, 0), 0.0);
  simulate(1, {2, "developed"}, plane.solver());
  EXPECT_EQ(plane.flows.at(0).z.size(), 0);
}

TEST_F(SimulateRuns, PartsOfTheUncertaintyAddUp) {
  const Simulation s = simulate(1, {2, "auto"});
  Array2 variance = Array2::Zero(2, s.x.size());
  for (const Array2& part : s.pressure_variance) variance += part;
  EXPECT_LT((variance.sqrt() - s.pressure_uncertainty).abs().maxCoeff(), 1e-9 * s.channel_drop);
  for (Index v = 0; v < 2; ++v) {
    EXPECT_NEAR(std::sqrt(s.drop_variance.col(v).sum()) / s.drop_uncertainty[v], 1.0, 1e-9);
  }
  EXPECT_NEAR(s.pressure_variance[0](0, 0), 1.0, 1e-9);  // numerical: one pascal at the inlet
}

TEST_F(SimulateRuns, NamesWhatIsNoRun) {
  const auto refused = [](const experiment::Experiment& of, const std::vector<std::string>& names) {
    try {
      ready_runs(of, names, station_by_station(), 1, {});
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  const std::string name = ready().calibration.runs[0].name;
  const std::string unknown = refused(experiment(), {"Q71"});
  EXPECT_NE(unknown.find("Q71"), std::string::npos);
  EXPECT_NE(unknown.find(name), std::string::npos) << unknown;
  EXPECT_NE(refused(experiment(), {}).find("--run"), std::string::npos);
  experiment::Experiment still = experiment();
  still.flow.clear();
  EXPECT_NE(refused(still, {"all"}).find("no flow runs"), std::string::npos);
  const ReadyRuns one = ready_runs(experiment(), {name, name}, station_by_station(), 1, {});
  EXPECT_EQ(one.calibration.runs.size(), 1u);
  EXPECT_EQ(one.findings.size(), 1u);
}

TEST_F(SimulateRuns, StopsWhenAskedTo) {
  Monitor monitor;
  monitor.stop_requested = [] { return true; };
  EXPECT_THROW(simulate_run(experiment(), ready(), 0, {2, "auto"}, stand_in, monitor), Interrupted);
}

TEST_F(SimulateRuns, DoubtsWhatIsNotConvergedOrRougherThanItsNoise) {
  Simulation s = simulate(0, {2, "developed"});
  EXPECT_TRUE(simulation_doubts(s, experiment()).empty());
  s.converged = 0.0;
  s.smoothing_taken = 2.0 * s.smoothing_noise;
  s.longest_silence = 2e-3;
  EXPECT_EQ(simulation_doubts(s, experiment()).size(), 3u);
  s.roof_map = 1.0;
  s.roof_taken = 4e-9;
  s.roof_misfit = 2.0;
  s.roof_odd = 3e-6;
  s.roof_odd_uncertainty = 1e-8;
  s.roof_odd_effect = -2e-3;
  const std::vector<std::string> doubts = simulation_doubts(s, experiment());
  ASSERT_EQ(doubts.size(), 5u);
  EXPECT_NE(doubts[2].find("2.0 times"), std::string::npos) << doubts[2];
  EXPECT_NE(doubts[3].find("3 um"), std::string::npos) << doubts[3];
  s.roof_odd_effect = -2e-5;  // asymmetric beyond doubt, and nothing to the flow
  EXPECT_EQ(simulation_doubts(s, experiment()).size(), 4u);
}

}  // namespace
}  // namespace manoscope::pipeline
