#include "manoscope/pipeline/flow_knowledge.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "manoscope/core/error.hpp"

namespace manoscope::pipeline {
namespace {

const flow::Channel kChannel{15.5 * mm, 1.7 * mm, 175.0 * um};

/// A picture of a wall whose section is `shape(s)`, the same at every x, on a rim at rest.
template <class Shape>
maps::ResponsePicture picture(Index n_across, Shape shape) {
  maps::ResponsePicture picture;
  picture.x = Array1::LinSpaced(60, -0.4e-3, 15.9e-3);
  picture.z = Array1::LinSpaced(n_across, -1.25e-3, 1.25e-3);
  picture.height = Array2::Zero(n_across, 60);
  for (Index iz = 0; iz < n_across; ++iz) {
    const double s = picture.z[iz] / 0.85e-3;
    if (std::abs(s) < 1.0) picture.height.row(iz).setConstant(shape(s));
  }
  return picture;
}

experiment::Experiment channel_of_s1() {
  experiment::Experiment experiment;
  experiment.channel.length = kChannel.length;
  experiment.channel.width = kChannel.width;
  experiment.channel.height = kChannel.height;
  experiment.fluid.viscosity = 1.0 * mPa_s;
  experiment.fluid.density = 998.0 * kg_per_m3;
  return experiment;
}

experiment::Passage duct(Length length) { return {length, 1.7 * mm, 175.0 * um, {}, {}}; }

TEST(ShapeAcross, IsThatOfTheWall) {
  const auto membrane =
      shape_across(picture(60, [](double s) { return 4e-6 * (1.0 - s * s); }), kChannel);
  const auto strip = shape_across(
      picture(60, [](double s) { return -4e-6 * (1.0 - s * s) * (1.0 - s * s); }), kChannel);
  ASSERT_TRUE(membrane && strip);
  // Both lie in the space of the fit: round-off.
  EXPECT_NEAR(membrane->crest(), 1.5, 1e-9);
  EXPECT_NEAR(strip->crest(), 1.875, 1e-9);
}

TEST(ShapeAcross, HeedsTheMiddleHalfAndLeavesOutWhatIsMissing) {
  maps::ResponsePicture seen = picture(60, [](double s) { return 4e-6 * (1.0 - s * s); });
  for (Index ix = 0; ix < 60; ++ix) {
    if (seen.x[ix] < 3e-3 || seen.x[ix] > 12.5e-3) seen.height.col(ix).setConstant(7.0);
    if (ix % 3 == 0) seen.height.col(ix).setConstant(std::numeric_limits<double>::quiet_NaN());
  }
  const auto shape = shape_across(seen, kChannel);
  ASSERT_TRUE(shape);
  EXPECT_NEAR(shape->crest(), 1.5, 1e-9);
}

TEST(ShapeAcross, IsNoneWhereTheMapsDoNotShowIt) {
  EXPECT_FALSE(shape_across(maps::ResponsePicture{}, kChannel));
  EXPECT_FALSE(shape_across(picture(6, [](double s) { return 1.0 - s * s; }), kChannel));
  // A wall that tilts: its mean says nothing of its shape.
  EXPECT_FALSE(shape_across(picture(60, [](double s) { return s * (1.0 - s * s); }), kChannel));
}

TEST(InletSpread, IsWhatTheExperimentSaysElseWhatAPassageLeaves) {
  experiment::Experiment experiment = channel_of_s1();
  EXPECT_EQ(inlet_spread(experiment, 70.0 * mL_per_min), 1.0);
  experiment.rigid.inlet = duct(50.0 * mm);
  // x+ = 1.8, where K still lacks some thousandths.
  EXPECT_LT(inlet_spread(experiment, 5.0 * mL_per_min), 3e-3);
  experiment.rigid.inlet = duct(2.0 * mm);
  const double slow = inlet_spread(experiment, 20.0 * mL_per_min);
  const double fast = inlet_spread(experiment, 70.0 * mL_per_min);
  EXPECT_GT(fast, 2.0 * slow);
  // x+ = x/(Dh Re) = 0.0051 with Re = 1244: by the correlation K = 0.67 of 0.84.
  EXPECT_NEAR(fast, 0.20, 0.02);
  experiment.inlet.spread = 0.25;
  EXPECT_EQ(inlet_spread(experiment, 70.0 * mL_per_min), 0.25);
}

TEST(Passages, AreNamedAndASimulationTakesTheirPlace) {
  experiment::Experiment experiment = channel_of_s1();
  EXPECT_TRUE(passages(experiment, 20.0 * mL_per_min).empty());
  experiment.rigid.inlet = duct(5.0 * mm);
  experiment.rigid.outlet = duct(10.0 * mm);
  experiment.rigid.outlet->fittings.into_reservoir = true;
  const auto parts = passages(experiment, 20.0 * mL_per_min);
  ASSERT_GE(parts.size(), 3u);
  EXPECT_EQ(parts[0].name, "inlet, duct");
  EXPECT_EQ(parts[1].name, "outlet, duct");
  EXPECT_NEAR(parts[1].drop / parts[0].drop, 2.0, 1e-12);
  EXPECT_EQ(parts[2].name, "outlet, expansion");
  // Without forward flow the ducts alone have a formula.
  const auto backwards = passages(experiment, -20.0 * mL_per_min);
  ASSERT_EQ(backwards.size(), 2u);
  EXPECT_NEAR(backwards[0].drop.si(), -parts[0].drop.si(), 1e-9 * parts[0].drop.si());

  experiment.rigid.simulated = {{10.0 * mL_per_min, 100.0 * Pa, 1.0 * Pa},
                                {40.0 * mL_per_min, 1000.0 * Pa, 5.0 * Pa}};
  const auto simulated = passages(experiment, 20.0 * mL_per_min);
  ASSERT_EQ(simulated.size(), 1u);
  EXPECT_NEAR(simulated[0].drop.si(), 300.0, 1e-9);  // 5 Q + 0.5 Q^2 through both
  EXPECT_THROW(passages(experiment, 50.0 * mL_per_min), InputError);
}

TEST(Passages, OfTheSameFormulaErrTogether) {
  experiment::Experiment experiment = channel_of_s1();
  const FlowRate Q = 20.0 * mL_per_min;
  experiment.rigid.inlet = duct(5.0 * mm);
  experiment.rigid.inlet->fittings.from_reservoir = true;
  experiment.rigid.inlet->fittings.into_reservoir = true;
  const auto error = [&] {
    return flow::parasitic_estimate(passages(experiment, Q), passage_uncertainty_of(experiment))
        .standard_uncertainty();
  };
  const double one = error();
  experiment.rigid.outlet = experiment.rigid.inlet;
  EXPECT_NEAR(error() / one, 2.0, 1e-12);
}

TEST(Passages, OfDuctsFollowFlowRateViscosityAndHeight) {
  experiment::Experiment experiment = channel_of_s1();
  const FlowRate Q = 20.0 * mL_per_min;
  experiment.rigid.inlet = duct(5.0 * mm);
  experiment.rigid.outlet = duct(10.0 * mm);
  const auto estimate = [&](FlowRate flow_rate) {
    return flow::parasitic_estimate(passages(experiment, flow_rate),
                                    passage_uncertainty_of(experiment));
  };
  EXPECT_EQ(estimate(Q).standard_uncertainty(), 0.0);
  experiment.instrument.flow_rate_uncertainty = 0.02;
  const double drop = estimate(Q).value;
  EXPECT_NEAR(estimate(Q).standard_uncertainty() / drop, 0.02, 1e-12);
  EXPECT_NEAR(estimate(-Q).standard_uncertainty() / drop, 0.02, 1e-12);
  experiment.fluid.viscosity_uncertainty = 0.01 * experiment.fluid.viscosity;
  EXPECT_NEAR(estimate(Q).standard_uncertainty() / drop, std::hypot(0.02, 0.01), 1e-12);
  // 1 % of one of two heights: 3 % of its share; the sides of the duct make it 2.93 %.
  experiment.instrument.flow_rate_uncertainty = 0.0;
  experiment.fluid.viscosity_uncertainty.reset();
  experiment.rigid.inlet->height_uncertainty = 0.01 * experiment.rigid.inlet->height;
  EXPECT_NEAR(estimate(Q).standard_uncertainty() / drop, 0.01, 3e-4);
  EXPECT_NEAR(estimate(-Q).standard_uncertainty() / drop, 0.01, 3e-4);
}

TEST(BehindPassage, AddsWhatThePassageTakes) {
  experiment::Experiment experiment = channel_of_s1();
  const FlowRate Q = 20.0 * mL_per_min;
  EXPECT_EQ(behind_passage(experiment, Q, 300.0 * Pa).pressure.si(), 300.0);
  experiment.rigid.outlet = duct(5.0 * mm);
  experiment.fluid.viscosity_uncertainty = 0.01 * mPa_s;
  const double drop = passages(experiment, Q)[0].drop.si();
  const validation::Outlet outlet = behind_passage(experiment, Q, 300.0 * Pa);
  EXPECT_NEAR(outlet.pressure.si(), 300.0 + drop, 1e-9);
  EXPECT_NEAR(outlet.uncertainty.si(), 0.01 * drop, 1e-9);
  experiment.instrument.flow_rate_uncertainty = 0.02;
  EXPECT_NEAR(behind_passage(experiment, Q, 300.0 * Pa).uncertainty.si(),
              std::hypot(0.01, 0.02) * drop, 1e-9);
}

TEST(OutletOf, IsReadOffTheWallUnlessAGaugeTellsIt) {
  experiment::Experiment experiment = channel_of_s1();
  const Index n = 32;
  FlowKnowledge knowledge;
  knowledge.setup.channel = kChannel;
  knowledge.setup.fluid = fluid_of(experiment);
  knowledge.setup = validation::with_tables(knowledge.setup, -1.0 * um, 1.0 * um);
  FlowRun run;
  run.flow_rate = 20.0 * mL_per_min;
  run.profile.x = Array1::LinSpaced(n, 0.0, 15.5e-3);
  run.profile.zeta = Array1::Zero(n);
  run.profile.uncertainty.independent = Array1::Zero(n);
  run.profile.flags = Flags1::Zero(n);
  // A wall that does not move: the flow is developed and p falls by r Q along x, to 400 Pa.
  const double fall = flow::passage_drop(experiment.fluid.viscosity, run.flow_rate,
                                         {kChannel.length, kChannel.width, kChannel.height})
                          .si();
  inversion::PressureReading reading;
  reading.x = run.profile.x;
  reading.pressure = 400.0 + fall * (1.0 - reading.x / 15.5e-3);
  reading.uncertainty.independent = Array1::Constant(n, 3.0);
  reading.flags = Flags1::Zero(n);
  const inversion::TestSection section{2, n - 4};
  const auto found = [&] { return outlet_of(experiment, knowledge, run, reading, section); };
  // Sections come from a table, 1e-8, and r by the series: a millipascal of the 1.4 kPa left.
  EXPECT_NEAR(found().pressure.si(), 400.0, 2e-3);
  EXPECT_GE(found().uncertainty.si(), 3.0);
  // What a passage costs does not tell the pressure behind it: a hose, a column of liquid.
  experiment.rigid.outlet = duct(5.0 * mm);
  EXPECT_NEAR(found().pressure.si(), 400.0, 2e-3);
  run.outlet_pressure = 50.0 * Pa;
  EXPECT_EQ(found().pressure.si(),
            behind_passage(experiment, run.flow_rate, 50.0 * Pa).pressure.si());
}

}  // namespace
}  // namespace manoscope::pipeline
