#include "manoscope/maps/noise.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "manoscope/core/flags.hpp"
#include "tests/support/synthetic_map.hpp"

namespace manoscope::maps {
namespace {

constexpr double kSigma = 20e-9;

/// White noise averaged over box_z x box_x pixels and scaled back to `kSigma`.
ChannelMap noise_map(Index nz, Index nx, Index box_z, Index box_x, std::uint64_t trial) {
  RandomStream stream(11, "noise", trial);
  Array2 white(nz + box_z - 1, nx + box_x - 1);
  for (Index i = 0; i < white.size(); ++i) white.data()[i] = stream.normal();
  ChannelMap map;
  map.grid = {nx, nz, 16.0 * um, 13.0 * um, Length{}, Length{}};
  map.height = Array2(nz, nx);
  map.flags = Flags2::Zero(nz, nx);
  const double scale = kSigma / std::sqrt(static_cast<double>(box_z * box_x));
  for (Index iz = 0; iz < nz; ++iz) {
    for (Index ix = 0; ix < nx; ++ix) {
      map.height(iz, ix) = scale * white.block(iz, ix, box_z, box_x).sum();
    }
  }
  return map;
}

Flags2 whole(const ChannelMap& map) { return Flags2::Ones(map.grid.nz, map.grid.nx); }

TEST(MeasureNoise, FindsWhiteNoiseAndItsLackOfReach) {
  for (std::uint64_t trial = 0; trial < 20; ++trial) {
    const ChannelMap map = noise_map(60, 400, 1, 1, trial);
    const PixelNoise noise = measure_noise(map, whole(map));
    const double n = 60.0 * 400.0;
    // The median absolute deviation has 37 % efficiency: relative error 1/sqrt(2 * 0.37 n).
    EXPECT_NEAR(noise.sigma.si() / kSigma, 1.0, 4.0 / std::sqrt(2.0 * 0.37 * n));
    // 1, but for the first lag standing above twice its noise (one map in 44): then 2 * 4/sqrt(n).
    EXPECT_NEAR(noise.length_x, 1.0, 8.0 / std::sqrt(n));
    EXPECT_NEAR(noise.length_z, 1.0, 8.0 / std::sqrt(n));
    EXPECT_GE(noise.length_x, 1.0);
    EXPECT_GE(noise.length_z, 1.0);
  }
}

TEST(MeasureNoise, FindsTheReachOfBlurredNoise) {
  // rho_k = 1 - k/m for a moving average of m pixels: 1 + 2 sum rho_k = m.
  constexpr int kTrials = 20;
  double sum_x = 0.0, sum_z = 0.0, sum_sigma = 0.0;
  for (std::uint64_t trial = 0; trial < kTrials; ++trial) {
    const ChannelMap map = noise_map(80, 300, 3, 5, trial);
    const PixelNoise noise = measure_noise(map, whole(map));
    // One map: each rho has an error of sqrt(sum rho^2 / n) = 1.7 %; 2 sum over the lags of the
    // kernel and as many stray ones beyond it, which share their error: 0.27 and 0.13. 4 of these.
    // A bound for these seeds: a long run of stray lags, always upwards, exceeds it now and then
    // (5 was found as 5.05 +- 0.2 over 200 other maps, but once as 6.6).
    EXPECT_NEAR(noise.length_x, 5.0, 4.0 * 0.27);
    EXPECT_NEAR(noise.length_z, 3.0, 4.0 * 0.13);
    sum_x += noise.length_x;
    sum_z += noise.length_z;
    sum_sigma += noise.sigma.si();
  }
  // Their mean has 20 times less variance; stray lags only ever add, half of the above at most.
  EXPECT_NEAR(sum_x / kTrials, 5.0, 4.0 * 0.27 / std::sqrt(kTrials) + 0.13);
  EXPECT_NEAR(sum_z / kTrials, 3.0, 4.0 * 0.13 / std::sqrt(kTrials) + 0.07);
  // 24000/15 independent patches a map.
  EXPECT_NEAR(sum_sigma / kTrials / kSigma, 1.0,
              4.0 / std::sqrt(2.0 * 0.37 * kTrials * 80.0 * 300.0 / 15.0));
}

TEST(MeasureNoise, LeavesOutSpikesDropoutsAndWhatIsNotRim) {
  ChannelMap map = noise_map(60, 400, 1, 1, 3);
  Flags2 rim = whole(map);
  rim.middleRows(20, 20).setZero();
  map.height.middleRows(20, 20).setConstant(50e-6);  // the bulge
  RandomStream stream(11, "spikes");
  for (int i = 0; i < 300; ++i) map.height(stream.below(20), stream.below(400)) += 1e-6;
  for (int i = 0; i < 300; ++i) {
    const Index iz = stream.below(20), ix = stream.below(400);
    map.height(iz, ix) = 1e3;
    map.flags(iz, ix) = PixelFlag::no_data;
  }
  const PixelNoise noise = measure_noise(map, rim);
  const double n = 40.0 * 400.0 - 300.0;
  // 2 % of outliers enlarge the median-based sigma by 1.4826 * 0.01 / (2 phi(0.674)) = 2.3 %.
  EXPECT_NEAR(noise.sigma.si() / kSigma, 1.023, 4.0 / std::sqrt(2.0 * 0.37 * n));
  EXPECT_NEAR(noise.length_x, 1.0, 8.0 / std::sqrt(n));
  EXPECT_NEAR(noise.length_z, 1.0, 8.0 / std::sqrt(n));
}

TEST(MeasureNoise, IsZeroWithoutNoiseOrRim) {
  ChannelMap map = noise_map(10, 30, 1, 1, 0);
  EXPECT_EQ(measure_noise(map, Flags2::Zero(10, 30)).sigma, Length{});
  map.height.setZero();
  const PixelNoise noise = measure_noise(map, whole(map));
  EXPECT_EQ(noise.sigma, Length{});
  EXPECT_EQ(noise.length_x, 1.0);
  EXPECT_EQ(noise.length_z, 1.0);
}

}  // namespace
}  // namespace manoscope::maps
