#include "manoscope/maps/despike.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>
#include <utility>

#include "manoscope/core/flags.hpp"
#include "tests/support/synthetic_map.hpp"

namespace manoscope::maps {
namespace {

using test_support::Bulge;
using test_support::MapErrors;

constexpr double kThreshold = 6.0;
constexpr Length kNoise = 20.0 * nm;
using Pixel = std::pair<Index, Index>;  // iz, ix

/// A wall of 15.5 x 1.7 mm in a map of 16.3 x 2.5 mm.
ChannelMap wall_map(Index nx, Index nz, const Bulge& bulge, double noise, std::uint64_t trial) {
  const CameraGrid camera{nx, nz, 16.3 * mm / static_cast<double>(nx),
                          2.5 * mm / static_cast<double>(nz)};
  const ChannelFrame frame = test_support::frame_at(
      15.5 * mm, 1.7 * mm, FlowDirection::plus_columns, false, 0.4 * mm, 0.4 * mm);
  MapErrors errors;
  errors.noise = noise;
  RandomStream stream(21, "despike", trial);
  return to_channel_frame(test_support::synthetic_map(camera, frame, bulge, errors, stream), frame);
}

ChannelMap flat_map(Index nx, Index nz, double noise, std::uint64_t trial) {
  return wall_map(nx, nz, {15.5e-3, 1.7e-3, 0.0}, noise, trial);
}

std::set<Pixel> flagged(const ChannelMap& map) {
  std::set<Pixel> pixels;
  for (Index iz = 0; iz < map.grid.nz; ++iz) {
    for (Index ix = 0; ix < map.grid.nx; ++ix) {
      if ((map.flags(iz, ix) & PixelFlag::spike) != 0) pixels.insert({iz, ix});
    }
  }
  return pixels;
}

TEST(FlagSpikes, FindsLonePixelsOfTenSigmaAndNothingElse) {
  ChannelMap map = flat_map(200, 100, kNoise.si(), 1);
  std::set<Pixel> spikes;
  for (Index iz = 5; iz < 100; iz += 10) {
    for (Index ix = 5; ix < 200; ix += 10) spikes.insert({iz, ix});
  }
  // 14 sigma: the pixel's own noise and that of four means must take off 8, a chance of 1e-10.
  for (const auto& [iz, ix] : spikes) {
    map.height(iz, ix) += ((iz + ix) % 20 == 0 ? 14.0 : -14.0) * kNoise.si();
  }
  const Array2 before = map.height;
  EXPECT_EQ(flag_spikes(map, kNoise, kThreshold), 200);
  EXPECT_EQ(flagged(map), spikes);
  EXPECT_TRUE((map.height == before).all());
}

TEST(FlagSpikes, FindsNearlyAllSpikesOfTenSigma) {
  ChannelMap map = flat_map(200, 100, kNoise.si(), 2);
  std::set<Pixel> spikes;
  for (Index iz = 5; iz < 100; iz += 10) {
    for (Index ix = 5; ix < 200; ix += 10) spikes.insert({iz, ix});
  }
  for (const auto& [iz, ix] : spikes) map.height(iz, ix) += 10.0 * kNoise.si();
  flag_spikes(map, kNoise, kThreshold);
  Index found = 0;
  for (const Pixel& pixel : flagged(map)) found += spikes.contains(pixel) ? 1 : 0;
  // Missed if noise takes off 4 sigma (0.2 %, the smallest of four steps), or where 49 noisy steps
  // happen to have a decile 30 % above their own 1.1 sigma (2 %).
  EXPECT_GE(found, 196);
}

/// Chance that white noise puts a pixel `t` sigma or more beyond the means of both its pairs of
/// neighbours along both axes: four independent means of variance 1/2, on either side.
double false_alarm(double t) {
  constexpr double kStep = 0.01, kReach = 10.0;
  double chance = 0.0;
  for (double h = -kReach; h < kReach; h += kStep) {
    const double density = std::exp(-0.5 * h * h) / std::sqrt(2.0 * std::numbers::pi);
    const double below = 0.5 * std::erfc(t - h);  // of a normal value of variance 1/2, below h - t
    chance += 2.0 * density * below * below * below * below * kStep;
  }
  return chance;
}

TEST(FlagSpikes, RaisesFalseAlarmsAsOftenAsFourMeansPredict) {
  EXPECT_LT(false_alarm(6.0), 1e-9);  // the documented rate
  for (const double threshold : {3.0, 4.0}) {
    double alarms = 0.0, pixels = 0.0;
    for (std::uint64_t trial = 0; trial < 12; ++trial) {
      ChannelMap map = flat_map(400, 200, kNoise.si(), trial);
      alarms += static_cast<double>(flag_spikes(map, kNoise, threshold));
      pixels += 400.0 * 200.0;
    }
    // 710 and 17 expected: Poisson, and 8 % for the border (1.5 % of the pixels, some 5 times as
    // prone, as they have one pair fewer).
    const double expected = false_alarm(threshold) * pixels;
    EXPECT_NEAR(alarms, expected, 4.0 * std::sqrt(expected) + 0.08 * expected) << threshold;
  }
}

TEST(FlagSpikes, LeavesTheseSteepNoiseFreeBulgesAlone) {
  for (const double crest : {5e-6, 50e-6, 200e-6, -50e-6}) {
    for (const auto& [nx, nz] : {Pixel{128, 24}, Pixel{128, 32}, Pixel{256, 48}, Pixel{512, 96}}) {
      for (const double taper : {0.2e-3, 0.54e-3, 1.5e-3}) {
        for (const Length noise : {1e-3 * nm, 1.0 * nm, 20.0 * nm}) {
          ChannelMap map = wall_map(nx, nz, {15.5e-3, 1.7e-3, crest, taper, 0.8}, 0.0, 0);
          EXPECT_EQ(flag_spikes(map, noise, kThreshold), 0)
              << crest << ' ' << nx << 'x' << nz << ' ' << taper << ' ' << noise.in(nm) << " nm";
        }
      }
    }
  }
}

/// Most pixels flagged in any of 150 bulges of random height, taper, fall and place in the map, on
/// cameras from 100 x 20 to 511 x 99 pixels.
Index worst_random_bulge(double noise) {
  Index worst = 0;
  for (std::uint64_t trial = 0; trial < 150; ++trial) {
    RandomStream stream(23, "bulges", trial);
    const Index nx = 100 + stream.below(412), nz = 20 + stream.below(80);
    const Bulge bulge{15.5e-3, 1.7e-3, std::pow(10.0, stream.uniform(-6.0, -3.7)),
                      stream.uniform(0.15e-3, 2e-3), stream.uniform(0.0, 0.95)};
    const ChannelFrame frame =
        test_support::frame_at(15.5 * mm, 1.7 * mm, FlowDirection::plus_columns, false,
                               Length::from_si(stream.uniform(0.3e-3, 0.5e-3)),
                               Length::from_si(stream.uniform(0.3e-3, 0.5e-3)));
    const CameraGrid camera{nx, nz, 16.3 * mm / static_cast<double>(nx),
                            2.5 * mm / static_cast<double>(nz)};
    MapErrors errors;
    errors.noise = noise;
    ChannelMap map =
        to_channel_frame(test_support::synthetic_map(camera, frame, bulge, errors, stream), frame);
    worst = std::max(
        worst, flag_spikes(map, noise > 0.0 ? Length::from_si(noise) : 1e-3 * nm, kThreshold));
  }
  return worst;
}

TEST(FlagSpikes, LeavesAnyBulgeAloneUnderOrdinaryNoise) {
  EXPECT_EQ(worst_random_bulge(kNoise.si()), 0);  // 1e-9 times 150 x 20000 pixels expected
}

TEST(FlagSpikes, FlagsNoMoreThanTheFourCornersOfANoiseFreeBulge) {
  // Where two kinks cross, one pixel can stand out in a map without any noise; documented.
  EXPECT_LE(worst_random_bulge(0.0), 4);
}

TEST(FlagSpikes, LeavesANoisyBulgeAloneAndFindsSpikesOnIt) {
  for (const auto& [nx, nz] : {Pixel{128, 24}, Pixel{512, 96}}) {
    ChannelMap map = wall_map(nx, nz, {15.5e-3, 1.7e-3, 50e-6, 0.54e-3, 0.5}, kNoise.si(), 5);
    EXPECT_EQ(flag_spikes(map, kNoise, kThreshold), 0) << nx;
    // Half a wavelength of green light, the least fringe-order error, on the crest and the flanks;
    // the coarse camera's curvature of 0.7 um from pixel to pixel hides less than some 4 times
    // that.
    const double size = nx == 128 ? 4e-6 : 266e-9;
    const std::set<Pixel> spikes{{nz / 2, nx / 2}, {nz / 4, nx / 3}, {nz / 2 + 3, nx / 4}};
    for (const auto& [iz, ix] : spikes) map.height(iz, ix) += size;
    flag_spikes(map, kNoise, kThreshold);
    EXPECT_EQ(flagged(map), spikes) << nx;
  }
}

TEST(FlagSpikes, FindsPairsAndBlocksOfTwo) {
  ChannelMap map = flat_map(60, 60, kNoise.si(), 7);
  const std::set<Pixel> spikes{{10, 10}, {10, 11},                       // along the flow
                               {20, 30}, {21, 30},                       // across
                               {40, 40}, {41, 41},                       // diagonal
                               {30, 10}, {30, 11}, {31, 10}, {31, 11}};  // two by two
  for (const auto& [iz, ix] : spikes) map.height(iz, ix) += 50.0 * kNoise.si();
  flag_spikes(map, kNoise, kThreshold);
  EXPECT_EQ(flagged(map), spikes);
}

TEST(FlagSpikes, FindsSpikesAtBordersAndCorners) {
  ChannelMap map = flat_map(60, 40, kNoise.si(), 8);
  const std::set<Pixel> spikes{{0, 0},  {0, 59}, {39, 0},  {39, 59},
                               {0, 30}, {20, 0}, {38, 20}, {10, 58}};
  for (const auto& [iz, ix] : spikes) map.height(iz, ix) += 50.0 * kNoise.si();
  flag_spikes(map, kNoise, kThreshold);
  EXPECT_EQ(flagged(map), spikes);
}

TEST(FlagSpikes, FindsASpikeNextToDropoutsAndCountsOnlyNewFlags) {
  ChannelMap map = flat_map(60, 40, kNoise.si(), 9);
  map.flags(20, 21) = map.flags(21, 20) = PixelFlag::no_data;  // beside the spike
  map.flags(5, 5) = PixelFlag::no_data;                        // no spike there, whatever it holds
  map.height(20, 21) = map.height(21, 20) = map.height(5, 5) = 1.0;
  map.height(20, 20) += 50.0 * kNoise.si();
  EXPECT_EQ(flag_spikes(map, kNoise, kThreshold), 1);
  EXPECT_EQ(flagged(map), (std::set<Pixel>{{20, 20}}));
  EXPECT_EQ(map.flags(5, 5), PixelFlag::no_data);
}

TEST(FlagSpikes, TakesAMapOfDropoutsOrOfOneRow) {
  ChannelMap empty = flat_map(20, 10, kNoise.si(), 1);
  empty.flags.setConstant(PixelFlag::no_data);
  EXPECT_EQ(flag_spikes(empty, kNoise, kThreshold), 0);
  ChannelMap row = flat_map(20, 1, kNoise.si(), 1);
  EXPECT_EQ(flag_spikes(row, kNoise, kThreshold), 0);
}

}  // namespace
}  // namespace manoscope::maps
