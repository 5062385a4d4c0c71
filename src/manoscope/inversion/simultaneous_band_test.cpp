#include "manoscope/inversion/simultaneous_band.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "manoscope/core/flags.hpp"
#include "manoscope/core/random.hpp"

namespace manoscope::inversion {
namespace {

/// A reading of n stations whose errors are a sum of bumps, each `width` stations wide.
PressureReading smooth_errors(Index n, double width) {
  PressureReading reading;
  reading.x = Array1::LinSpaced(n, 0.0, 1.0);
  reading.pressure = Array1::Zero(n);
  reading.flags = Flags1::Zero(n);
  reading.uncertainty.independent = Array1::Zero(n);
  for (double at = -3.0 * width; at < static_cast<double>(n) + 3.0 * width; at += 0.5 * width) {
    const Array1 z = (Array1::LinSpaced(n, 0.0, static_cast<double>(n - 1)) - at) / width;
    reading.uncertainty.modes.push_back({"bump " + std::to_string(at), "test", (-z * z).exp()});
  }
  return reading;
}

/// Share of draws of the errors that stay within k standard uncertainties everywhere.
double share_within(const PressureReading& reading, double k) {
  constexpr int kDraws = 4000;
  RandomStream random(5, "band");
  const Array1 standard = reading.uncertainty.standard();
  const Index n = reading.x.size();
  int within = 0;
  for (int draw = 0; draw < kDraws; ++draw) {
    Array1 error = Array1::Zero(n);
    for (const ErrorMode& mode : reading.uncertainty.modes) error += random.normal() * mode.effect;
    for (Index i = 0; i < n; ++i) error[i] += random.normal() * reading.uncertainty.independent[i];
    if ((error.abs() <= k * standard).all()) ++within;
  }
  return static_cast<double>(within) / kDraws;
}

TEST(SimultaneousFactor, HoldsTheWholeCurveAsOftenAsItSays) {
  for (const double width : {4.0, 15.0, 80.0}) {
    const PressureReading reading = smooth_errors(300, width);
    const double k = simultaneous_factor(reading, 0.95);
    EXPECT_GT(k, 1.96);
    // The formula counts the mean number of ways out: a little too wide, by what leaves twice.
    // 4000 draws: 0.35 %, three times.
    EXPECT_NEAR(share_within(reading, k), 0.95, 0.0105 + 0.01) << width;
  }
}

TEST(SimultaneousFactor, OfOneCommonErrorIsThatOfOneStation) {
  PressureReading reading = smooth_errors(50, 10.0);
  reading.uncertainty.modes = {{"common", "test", Array1::Constant(50, 3.0)}};
  EXPECT_NEAR(simultaneous_factor(reading, 0.95), 1.959964, 1e-4);
  EXPECT_NEAR(simultaneous_factor(reading, 0.99), 2.575829, 1e-4);
}

TEST(SimultaneousFactor, OfIndependentErrorsIsSidaks) {
  PressureReading reading = smooth_errors(100, 10.0);
  reading.uncertainty.modes.clear();
  reading.uncertainty.independent = Array1::Constant(100, 2.0);
  const double k = simultaneous_factor(reading, 0.95);
  EXPECT_NEAR(share_within(reading, k), 0.95, 0.0105);
}

TEST(SimultaneousFactor, HeedsAnsweredStationsAlone) {
  PressureReading reading = smooth_errors(100, 5.0);
  reading.flags.setConstant(ReadingFlag::no_data);
  EXPECT_EQ(simultaneous_factor(reading, 0.95), 0.0);
  reading.flags[7] = 0;
  EXPECT_NEAR(simultaneous_factor(reading, 0.95), 1.959964, 1e-4);
}

}  // namespace
}  // namespace manoscope::inversion
