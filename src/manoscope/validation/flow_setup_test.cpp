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
