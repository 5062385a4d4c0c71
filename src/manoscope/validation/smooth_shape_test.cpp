#include "manoscope/validation/smooth_shape.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "manoscope/core/error.hpp"
#include "manoscope/core/flags.hpp"
#include "manoscope/core/random.hpp"
#include "manoscope/validation/error_table.hpp"

namespace manoscope::validation {
namespace {

constexpr flow::Channel kChannel{15.5 * mm, 1.7 * mm, 175.0 * um};
constexpr Index kStations = 512;

/// Under flow a stretched wall of 33 um that falls along x and rises from its ends within w/pi.
Array1 truth(const Array1& x) {
  const double l = kChannel.length.si(), rise = kChannel.width.si() / std::numbers::pi;
  return 33e-6 * (1.0 - 0.6 * x / l) * (1.0 - (-x / rise).exp()) * (1.0 - ((x - l) / rise).exp());
}

/// The profile of a map with noise of a seed, 0: none drawn; an offset as a mode beside it.
Profile profile(double noise, std::uint64_t seed) {
  RandomStream stream(seed, "smooth shape", 0);
  Profile state;
  // A camera that sees a little of the rim.
  state.x = Array1::LinSpaced(kStations, -0.1e-3, 15.6e-3);
  state.zeta = truth(state.x);
  for (double& zeta : state.zeta) zeta += seed == 0 ? 0.0 : noise * stream.normal();
  state.uncertainty.independent = Array1::Constant(kStations, noise);
  state.uncertainty.modes.push_back({"offset", "leveling", Array1::Constant(kStations, 5e-9)});
  state.flags = Flags1::Zero(kStations);
  return state;
}

TEST(SmoothShape, RecoversTheWallWithinItsStatedUncertainty) {
  const Array1 x = Array1::LinSpaced(300, 0.0, kChannel.length.si());
  for (const double noise : {2e-9, 20e-9, 500e-9}) {
    double square = 0.0, pull = 0.0, taken = 0.0;
    constexpr int kTrials = 10;
    for (int trial = 1; trial <= kTrials; ++trial) {
      const SmoothShape shape(profile(noise, static_cast<std::uint64_t>(trial)), kChannel);
      const Array1 error = shape.zeta(x) - truth(x);
      square += error.square().mean() / kTrials;
      pull += (error / shape.standard(x)).square().mean() / kTrials;
      taken += std::pow(shape.taken() / shape.noise(), 2) / kTrials;
      EXPECT_NEAR(shape.noise() / Length::from_si(noise), 1.0, 1e-12);
    }
    EXPECT_LT(std::sqrt(square), 0.6 * noise) << noise;
    // Mean square pull 1 on average over x, of some 200 to 400 degrees of freedom and less bias.
    EXPECT_GT(pull, 0.6) << noise;
    EXPECT_LT(pull, 1.4) << noise;
    // Of 5000 stations the mean square is known to 2 %: never more than the noise was taken away.
    EXPECT_LT(taken, 1.08) << noise;
    EXPECT_GT(taken, 0.7) << noise;
  }
}

TEST(SmoothShape, SmoothsOverMoreWhereThereIsMoreNoise) {
  const SmoothShape fine(profile(2e-9, 1), kChannel), coarse(profile(500e-9, 1), kChannel);
  EXPECT_GE(fine.half_wavelength(), 2.0 * kChannel.height);
  EXPECT_GT(coarse.half_wavelength(), 1.5 * fine.half_wavelength());
}

TEST(SmoothShape, HoldsTheClampedEnds) {
  const SmoothShape shape(profile(20e-9, 3), kChannel);
  const Array1 ends = shape.zeta(Array1{{0.0, kChannel.length.si()}});
  EXPECT_LT(ends.abs().maxCoeff(), 1e-9);
  EXPECT_EQ(shape.positions()[0], 0.0);
  EXPECT_EQ(shape.positions()[shape.positions().size() - 1], kChannel.length.si());
}

TEST(SmoothShape, BridgesWhatIsSilent) {
  Profile state = profile(20e-9, 2);
  for (Index ix = 0; ix < kStations; ++ix) {
    const bool silent = (state.x[ix] > 1.0e-3 && state.x[ix] < 1.2e-3) ||
                        (state.x[ix] > 8.0e-3 && state.x[ix] < 9.5e-3);
    if (silent) {
      state.flags[ix] = StationFlag::no_data;
      state.zeta[ix] = 0.0;
    }
  }
  const SmoothShape shape(state, kChannel);
  EXPECT_NEAR(shape.longest_silence().in(mm), 1.5, 0.05);
  const Array1 x = Array1{{1.1e-3, 8.7e-3}};
  const Array1 error = (shape.zeta(x) - truth(x)).abs(), bar = shape.standard(x);
  EXPECT_LT(error[0], 3.0 * bar[0]);
  EXPECT_LT(error[1], 3.0 * bar[1]);
  EXPECT_LT(error.maxCoeff(), 0.2e-6);  // a straight line is 0.3 um off near the end
}

TEST(SmoothShape, CarriesEveryErrorOfTheProfile) {
  const Profile state = profile(20e-9, 1);
  const SmoothShape shape(state, kChannel);
  const Array1 x = Array1{{5e-3, 7e-3, 9e-3}};
  const Profile smooth = shape.at(x);
  EXPECT_EQ((smooth.zeta - shape.zeta(x)).abs().maxCoeff(), 0.0);
  double noise = 0.0;
  int own = 0;
  for (const ErrorMode& mode : smooth.uncertainty.modes) {
    if (mode.variable == "offset") {
      // A smooth error comes through whole.
      EXPECT_NEAR(mode.effect[1], 5e-9, 1e-11);
      continue;
    }
    EXPECT_EQ(mode.source, "pixel noise");
    noise += mode.effect[1] * mode.effect[1];
    own += mode.variable == flow_noise(kStations / 2) ? 1 : 0;
  }
  EXPECT_EQ(own, 1);
  // Noise of many stations averages; what smoothing may hide comes on top in standard().
  EXPECT_LT(std::sqrt(noise), shape.standard(x)[1]);
  EXPECT_GT(std::sqrt(noise), 0.5 * shape.standard(x)[1]);
}

TEST(SmoothShape, RefusesAChannelWithoutStations) {
  Profile state = profile(20e-9, 1);
  for (Index ix = 5; ix < kStations; ++ix) state.flags[ix] = StationFlag::no_data;
  EXPECT_THROW(SmoothShape(state, kChannel), InputError);
}

}  // namespace
}  // namespace manoscope::validation
