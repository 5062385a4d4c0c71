// Drop, Reynolds number and p(x) that the measured gap gives along the whole channel.
#include <gtest/gtest.h>

#include "manoscope/core/flags.hpp"
#include "manoscope/validation/test_trial.hpp"

namespace manoscope::validation {
namespace {

Profile even_bulge(double zeta) {
  return test::exact_profile(LocalWall().stations(kStations), [&](double) { return zeta; });
}

/// Trapezoid rule over flat ends of 0.5 mm and a middle of constant f, by hand.
double whole_channel(double f_end, double f_middle) {
  return 14.5e-3 * f_middle + 2.0 * 0.5e-3 * 0.5 * (f_end + f_middle);
}

TEST(WholeChannel, IsClampedAtBothEnds) {
  const double q = 20e-6 / 60.0;
  const Profile state = even_bulge(30e-6);
  const double drop = channel_resistance_drop(kChannel, kWater, 20.0 * mL_per_min, state).si();
  const double drop_by_hand =
      q * whole_channel(resistance_by_hand(175e-6), resistance_by_hand(205e-6));
  EXPECT_NEAR(drop / drop_by_hand, 1.0, 1e-12);
  const auto reynolds = [&](double gap) { return 2.0 * q * 998.0 / 1e-3 / (1.7e-3 + gap); };
  const double re_by_hand = whole_channel(reynolds(175e-6), reynolds(205e-6)) / 15.5e-3;
  EXPECT_NEAR(mean_reynolds(kChannel, kWater, 20.0 * mL_per_min, state) / re_by_hand, 1.0, 1e-12);
}

TEST(WholeChannel, TakesMeasuredEndsAsTheyAre) {
  Profile state =
      test::exact_profile(Array1::LinSpaced(32, 0.0, 15.5e-3), [](double) { return 30e-6; });
  const double drop = channel_resistance_drop(kChannel, kWater, 20.0 * mL_per_min, state).si();
  EXPECT_NEAR(drop / (20e-6 / 60.0 * 15.5e-3 * resistance_by_hand(205e-6)), 1.0, 1e-12);
  state.flags[0] = StationFlag::no_data;  // now the clamp speaks for the inlet
  EXPECT_GT(channel_resistance_drop(kChannel, kWater, 20.0 * mL_per_min, state).si(), 1.001 * drop);
}

TEST(WholeChannel, WithoutAnyStationIsTheUndeflectedOne) {
  Profile state = even_bulge(30e-6);
  state.flags.setConstant(StationFlag::no_data);
  const double drop = channel_resistance_drop(kChannel, kWater, 20.0 * mL_per_min, state).si();
  EXPECT_NEAR(drop / (20e-6 / 60.0 * 15.5e-3 * resistance_by_hand(175e-6)), 1.0, 1e-12);
}

TEST(WholeChannel, SkipsStationsWithoutData) {
  Profile state = even_bulge(30e-6);
  const double whole = mean_reynolds(kChannel, kWater, 20.0 * mL_per_min, state);
  state.flags[5] = state.flags[13] = StationFlag::no_data;
  state.zeta[5] = state.zeta[13] = 0.0;
  EXPECT_NEAR(mean_reynolds(kChannel, kWater, 20.0 * mL_per_min, state) / whole, 1.0, 1e-12);
}

// ---- p(x) that the gap gives ----

TEST(ResistancePressure, MeetsTheReadingAtTheEndAndFallsByQr) {
  const Trial trial;
  const Profile state = trial.state();
  const PressureReading reading = trial.reading(state);
  const Array1 p =
      resistance_pressure(kChannel, kWater, 40.0 * mL_per_min, state, reading, kSection);
  ASSERT_EQ(p.size(), kStations);
  EXPECT_EQ(p[kSection.last], reading.pressure[kSection.last]);
  for (Index i = 1; i < kStations; ++i) {
    const double r = 0.5 * (resistance_by_hand(175e-6 + state.zeta[i - 1]) +
                            resistance_by_hand(175e-6 + state.zeta[i]));
    // Round-off of 1e4 Pa.
    EXPECT_NEAR(p[i - 1] - p[i], 40e-6 / 60.0 * r * (state.x[i] - state.x[i - 1]), 1e-9);
  }
}

TEST(ResistancePressure, FallsOverTheTestSectionByTheComparedDrop) {
  const Trial trial;
  for (const bool hole : {false, true}) {
    Profile state = trial.state();
    if (hole) state.flags.segment(8, 4).setConstant(StationFlag::no_data);
    const PressureReading reading = trial.reading(state);
    const auto found = compare(reading, state, 40.0 * mL_per_min);
    const Array1 p =
        resistance_pressure(kChannel, kWater, 40.0 * mL_per_min, state, reading, kSection);
    EXPECT_NEAR(p[kSection.first] - p[kSection.last], found.resistance.value, 1e-8);
  }
}

TEST(ResistancePressure, BridgesAHoleAtTheSecondOrder) {
  // Bridges of straight resistance err by Q r'' d^3/12 at most: 2 Pa for 3 mm here, where a
  // straight pressure would err by Q r' d^2/8.
  const Trial trial;
  Profile state = trial.state();
  const PressureReading reading = trial.reading(state);
  const FlowRate flow_rate = 40.0 * mL_per_min;
  const Array1 whole = resistance_pressure(kChannel, kWater, flow_rate, state, reading, kSection);
  state.flags.segment(9, 4).setConstant(StationFlag::no_data);
  state.zeta.segment(9, 4).setZero();
  const Array1 bridged = resistance_pressure(kChannel, kWater, flow_rate, state, reading, kSection);
  EXPECT_LT((bridged - whole).abs().maxCoeff(), 2.0);
}

}  // namespace
}  // namespace manoscope::validation
