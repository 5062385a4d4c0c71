#include "manoscope/validation/flow_setup.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "manoscope/core/error.hpp"
#include "manoscope/core/flags.hpp"

namespace manoscope::validation {
namespace {

constexpr flow::Channel kChannel{15.5 * mm, 1.7 * mm, 175.0 * um};

Profile profile(std::initializer_list<double> x_mm) {
  Profile state;
  state.x = Array1(static_cast<Index>(x_mm.size()));
  std::copy(x_mm.begin(), x_mm.end(), state.x.data());
  state.x *= 1e-3;
  state.zeta = Array1::Constant(state.x.size(), 20e-6);
  state.uncertainty.independent = Array1::Zero(state.x.size());
  state.flags = Flags1::Zero(state.x.size());
  return state;
}

FlowSetup setup() {
  FlowSetup result;
  result.channel = kChannel;
  result.fluid = {1.0 * mPa_s, 998.0 * kg_per_m3};
  return result;
}

TEST(WallLine, AddsTheClampedEndsAndLeavesOutWhatDoesNotCount) {
  Profile state = profile({-0.1, 0.1, 5.0, 10.0, 15.4, 15.6});
  state.flags[2] = StationFlag::no_data;
  const WallLine line = wall_line(state, kChannel.length);
  EXPECT_EQ(line.station, (std::vector<Index>{kClampedEnd, 1, 3, 4, kClampedEnd}));
  EXPECT_EQ(line.zeta[0], 0.0);
  EXPECT_EQ(line.zeta[1], 20e-6);
  EXPECT_EQ(line.x[4], kChannel.length.si());
}

TEST(WallLine, TakesStationsAtTheEndsAsTheyAre) {
  const WallLine line = wall_line(profile({0.0, 5.0, 15.5}), kChannel.length);
  EXPECT_EQ(line.station, (std::vector<Index>{0, 1, 2}));
}

/// The mean deflection of a stretched wall, 30 um, which rises from its clamped ends over w/(2 pi).
double risen(double x) {
  const double rise = kChannel.width.si() / 6.283, l = kChannel.length.si();
  return 30e-6 * (1.0 - std::exp(-x / rise) - std::exp(-(l - x) / rise));
}

/// Stations 64 um apart, some outside the channel. Missing are the first inside, a patch of 0.13 mm
/// near the inlet and one of 1.9 mm.
Profile patched() {
  Profile state = profile({});
  state.x = Array1::LinSpaced(247, -0.0946e-3, 15.5946e-3);
  state.zeta = state.x.unaryExpr([](double x) { return risen(x); });
  state.uncertainty.independent = Array1::Constant(247, 4e-9);
  state.uncertainty.modes = {{"plane", "leveling", 1e-9 * (1.0 + state.x / 15.5e-3)}};
  state.flags = Flags1::Zero(247);
  for (const Index ix : {2, 5, 6}) state.flags[ix] = StationFlag::no_data;
  for (Index ix = 100; ix < 130; ++ix) state.flags[ix] = StationFlag::no_data;
  for (Index ix = 0; ix < 247; ++ix) {
    if (state.flags[ix] != 0) state.zeta[ix] = 0.0;
  }
  return state;
}

TEST(Bridged, CarriesTheDeflectionOverShortStretchesWithoutData) {
  const Profile state = patched(), whole = bridged(state, kChannel.length, kChannel.width);
  for (const Index ix : {2, 5, 6}) {
    EXPECT_EQ(whole.flags[ix], 0);
    // A straight line is up to 1.5 um off; a spline over 0.19 mm by h^4 zeta''''/384, 0.02 um, but
    // next to its end at the rim, where it does not bend, by a tenth of the straight line's.
    EXPECT_NEAR(whole.zeta[ix], risen(state.x[ix]), ix == 2 ? 0.2e-6 : 0.05e-6) << ix;
    EXPECT_GT(whole.uncertainty.independent[ix], 1e-9);
    EXPECT_LT(whole.uncertainty.independent[ix], 8e-9);
  }
  // The spline goes through the errors of its neighbours, which are straight in x, and through none
  // at the clamped end: some per cent.
  EXPECT_NEAR(whole.uncertainty.modes[0].effect[6], state.uncertainty.modes[0].effect[6], 5e-11);
  // 1.9 mm are longer than the channel is wide; outside the channel there is nothing to bridge.
  EXPECT_NE(whole.flags[110], 0);
  EXPECT_EQ(whole.zeta[50], state.zeta[50]);
}

TEST(ModelledRun, SpreadsTheInletTowardsTheOtherProfile) {
  FlowSetup with = setup();
  Profile state = profile({});
  state.x = Array1::LinSpaced(80, 0.1e-3, 15.4e-3);
  state.zeta = Array1::Constant(80, 20e-6);
  state.flags = Flags1::Zero(80);
  const WallLine line = wall_line(state, kChannel.length);
  const FlowRate fast = 70.0 * mL_per_min;
  const auto drop_of = [&](flow::InletProfile inlet) {
    with.inlet = inlet;
    return modelled_run(flow::FlowModel::plane_march, with, fast, line).pressure()[0];
  };
  const double uniform = drop_of(flow::InletProfile::uniform);
  const double developed = drop_of(flow::InletProfile::developed);
  const ModelledRun run = modelled_run(flow::FlowModel::plane_march, with, fast, line);
  // The rectangular distribution about its end; the same march twice: round-off.
  EXPECT_NEAR(run.inlet_effect[0] * std::sqrt(3.0) / (uniform - developed), 1.0, 1e-9);
  with.inlet_spread = 0.0;
  EXPECT_EQ(modelled_run(flow::FlowModel::paper, with, fast, line).inlet_effect.maxCoeff(), 0.0);
  with.inlet_spread = 2.0;
  EXPECT_THROW(modelled_run(flow::FlowModel::paper, with, fast, line), InputError);
}

}  // namespace
}  // namespace manoscope::validation
