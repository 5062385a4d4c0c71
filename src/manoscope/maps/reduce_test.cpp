#include "manoscope/maps/reduce.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "manoscope/core/error.hpp"
#include "manoscope/core/flags.hpp"
#include "tests/support/synthetic_map.hpp"

namespace manoscope::maps {
namespace {

using test_support::Bulge;
using test_support::frame_at;
using test_support::MapErrors;
using test_support::Pulls;

constexpr Length kNoise = 20.0 * nm;
const Bulge kBulge{15.5e-3, 1.7e-3, 20e-6, 0.54e-3, 0.6};

ChannelFrame plain_frame() {
  return frame_at(15.5 * mm, 1.7 * mm, FlowDirection::plus_columns, false, 0.4 * mm, 0.4 * mm);
}

/// 16.3 x 2.5 mm in 512 x 96 pixels, with all that an interferometer adds.
CameraGrid camera() { return {512, 96, 16.3 * mm / 512.0, 2.5 * mm / 96.0}; }

MapErrors everything(RandomStream& stream) {
  MapErrors errors;
  errors.noise = kNoise.si();
  errors.tilt_columns = stream.uniform(-2e-4, 2e-4);
  errors.tilt_rows = stream.uniform(-2e-4, 2e-4);
  errors.piston = stream.uniform(-5e-6, 5e-6);
  errors.dropouts = 0.02;
  errors.blobs = 4;
  errors.blob_radius = 60e-6;
  errors.spikes = 0.002;
  errors.spike_size = 300e-9;
  errors.shift_columns = stream.uniform(-0.5, 0.5) * camera().pitch_x.si();
  return errors;
}

TEST(ReduceMap, StatesTheErrorOfItsProfileTruly) {
  constexpr int kTrials = 12;
  Pulls all, middle, shifts, crest;
  for (int trial = 0; trial < kTrials; ++trial) {
    RandomStream stream(61, "whole", static_cast<std::uint64_t>(trial));
    const MapErrors errors = everything(stream);
    const HeightMap map =
        test_support::synthetic_map(camera(), plain_frame(), kBulge, errors, stream);
    const ReducedMap reduced =
        reduce_map(map, plain_frame(),
                   trial % 2 == 0 ? MapKnowledge{} : MapKnowledge{.height_noise = kNoise}, "m");
    const Profile& profile = reduced.profile;
    const Array1 sigma = profile.uncertainty.standard();
    ASSERT_EQ(profile.x.size(), 486);  // the first at 0.015 mm, steps of 31.8 um
    double n = 0.0, good = 0.0;
    for (Index i = 0; i < profile.x.size(); ++i) {
      n += 1.0;
      if (profile.flags[i] != 0) continue;
      good += 1.0;
      const double pull = (profile.zeta[i] - kBulge.width_average(profile.x[i])) / sigma[i];
      all.add(pull);
      if (profile.x[i] > 3e-3 && profile.x[i] < 12.5e-3) middle.add(pull);
    }
    EXPECT_GT(good / n, 0.95);
    shifts.add(errors.shift_columns / (camera().pitch_x.si() / std::sqrt(12.0)));
    crest.add((reduced.crest - kBulge(0.5 * 15.5e-3, 0.0)) / reduced.crest_uncertainty);

    EXPECT_NEAR(reduced.condition.tilt_x, errors.tilt_columns, 1e-7);
    EXPECT_NEAR(reduced.condition.tilt_z, errors.tilt_rows, 1e-6);
    EXPECT_NEAR(reduced.condition.noise.sigma.si(), kNoise.si(), 0.03 * kNoise.si());
    EXPECT_NEAR(reduced.condition.noise.length_x, 1.0, 0.15);
    EXPECT_NEAR(reduced.condition.noise.length_z, 1.0, 0.15);
    EXPECT_NEAR(reduced.condition.missing, 0.02, 0.004);
    EXPECT_NEAR(reduced.condition.spikes, 0.002, 0.0006);
  }
  RecordProperty("mean", std::to_string(all.mean()));
  RecordProperty("width", std::to_string(all.width()));
  // In the middle pixel noise leads (2.5 nm); the quadrature of 65 pixels across takes off up to
  // 2/3 * 20 um / 65^2 = 3.2 nm at the inlet, 2.2 on the mean, 0.9 standard uncertainties, which
  // cancels in a reading. Its square adds to the width.
  EXPECT_NEAR(middle.mean(), -0.45, 0.45 + 0.1);
  EXPECT_NEAR(middle.width(), 1.15, 0.2);
  // At the ends the shift leads: one draw a map, shared by all stations there, so the width is that
  // of twelve draws.
  EXPECT_NEAR(all.width(), 1.1, 0.25) << "shifts drawn: " << shifts.width();
  EXPECT_NEAR(crest.mean(), 0.0, 4.0 / std::sqrt(kTrials));
  EXPECT_NEAR(crest.width(), 1.0, 4.0 / std::sqrt(2.0 * kTrials));
}

TEST(ReduceMap, GivesTheSameProfileInEveryOrientation) {
  Array1 first;
  for (const FlowDirection flow : {FlowDirection::plus_columns, FlowDirection::minus_columns,
                                   FlowDirection::plus_rows, FlowDirection::minus_rows}) {
    for (const bool reversed : {false, true}) {
      ChannelFrame frame = frame_at(15.5 * mm, 1.7 * mm, flow, reversed, 0.4 * mm, 0.4 * mm);
      frame.outward = reversed ? Outward::minus_height : Outward::plus_height;
      CameraGrid grid = camera();
      if (!frame.along_columns()) {
        std::swap(grid.nx, grid.ny);
        std::swap(grid.pitch_x, grid.pitch_y);
      }
      MapErrors errors;
      errors.tilt_columns = 1e-4;
      RandomStream stream(61, "unused");
      const ReducedMap reduced =
          reduce_map(test_support::synthetic_map(grid, frame, kBulge, errors, stream), frame,
                     {.height_noise = kNoise}, "m");
      EXPECT_EQ(reduced.condition.spikes, 0.0);
      if (first.size() == 0) first = reduced.profile.zeta;
      ASSERT_EQ(reduced.profile.zeta.size(), first.size());
      // Map and channel are symmetric in the camera, so the samples are the same: round-off of
      // 10 um heights and of the plane through them.
      EXPECT_LT((reduced.profile.zeta - first).abs().maxCoeff(), 1e-15);
    }
  }
}

TEST(ReduceMap, MeasuresTheCrestNotTheMeanAroundIt) {
  MapErrors errors;
  for (const Index coarse : {1, 4}) {
    const CameraGrid grid{512 / coarse, 96 / coarse,
                          16.3 * mm / 512.0 * static_cast<double>(coarse),
                          2.5 * mm / 96.0 * static_cast<double>(coarse)};
    RandomStream stream(61, "unused");
    const ReducedMap reduced =
        reduce_map(test_support::synthetic_map(grid, plain_frame(), kBulge, errors, stream),
                   plain_frame(), {.height_noise = kNoise}, "m");
    const double truth = kBulge(0.5 * 15.5e-3, 0.0);
    // No noise in the map: what is left is the curve's own, a small part of the stated noise.
    EXPECT_NEAR(reduced.crest, truth, 0.5 * reduced.crest_uncertainty) << coarse;
    EXPECT_LT(reduced.crest_uncertainty, kNoise.si());
  }
}

TEST(ReduceMap, GivesNoCrestWhereTheMiddleHoldsNoData) {
  RandomStream stream(61, "unused");
  const HeightMap whole = test_support::synthetic_map(camera(), plain_frame(), kBulge, {}, stream);
  Array2 height = whole.height();
  height.block(0, 226, 96, 60).setConstant(std::numeric_limits<double>::quiet_NaN());
  const ReducedMap reduced =
      reduce_map({camera(), height}, plain_frame(), {.height_noise = kNoise}, "m");
  EXPECT_TRUE(std::isnan(reduced.crest));
  EXPECT_TRUE(std::isnan(reduced.crest_uncertainty));
  EXPECT_EQ((reduced.profile.flags != 0).count(), 60);
}

TEST(ReduceMap, GivesTheShiftModeTheSlopeOfTheProfile) {
  RandomStream stream(61, "unused");
  ReduceOptions options;
  options.shift_uncertainty = 10.0 * um;
  const ReducedMap reduced =
      reduce_map(test_support::synthetic_map(camera(), plain_frame(), kBulge, {}, stream),
                 plain_frame(), {.height_noise = kNoise}, "h07.gsf", options);
  const ErrorMode& mode = reduced.profile.uncertainty.modes.back();
  EXPECT_EQ(mode.variable, "shift of h07.gsf");
  EXPECT_EQ(mode.source, "registration");
  for (Index i = 10; i + 10 < reduced.profile.x.size(); ++i) {
    const double x = reduced.profile.x[i], d = 1e-6;
    const double slope = (kBulge.width_average(x + d) - kBulge.width_average(x - d)) / (2.0 * d);
    // A line through nine columns errs by 1.97 d^2 zeta''' (1.97 = sum j^4 / 6 sum j^2), zeta'''
    // that of the tapers and a quarter more for the next order; the quadrature of 65 pixels across
    // errs by 1/65^2 of the value.
    const double taper = kBulge.taper, d_x = camera().pitch_x.si();
    const double third = 2.0 / 3.0 * kBulge.crest / std::pow(taper, 3) *
                         (std::exp(-x / taper) + std::exp(-(15.5e-3 - x) / taper));
    EXPECT_NEAR(
        mode.effect[i], slope * 10e-6,
        1.25 * 1.97 * d_x * d_x * third * 10e-6 + std::abs(slope * 10e-6) / (65.0 * 65.0) + 1e-13);
  }
}

TEST(ReduceMap, FindsItsRimOnACoarseCamera) {
  // 128 x 24 pixels show 0.4 mm of rim in three or four pixels.
  const CameraGrid grid{128, 24, 16.3 * mm / 128.0, 2.5 * mm / 24.0};
  RandomStream stream(61, "coarse");
  MapErrors errors;
  errors.noise = kNoise.si();
  errors.tilt_rows = 1e-4;
  const ReducedMap reduced =
      reduce_map(test_support::synthetic_map(grid, plain_frame(), kBulge, errors, stream),
                 plain_frame(), {}, "m");
  EXPECT_NEAR(reduced.condition.tilt_z, 1e-4, 4.0 * 20e-9 / (0.9e-3 * std::sqrt(500.0)));
  EXPECT_EQ(reduced.condition.spikes, 0.0);
}

TEST(ReduceMap, NamesTheMapThatShowsNoRim) {
  const HeightMap flat({512, 96, camera().pitch_x, camera().pitch_y}, Array2::Zero(96, 512));
  ReduceOptions options;
  options.rim_margin = 5.0 * mm;
  try {
    reduce_map(flat, plain_frame(), {}, "h04.gsf", options);
    FAIL() << "no rim is left outside a margin of 5 mm";
  } catch (const InputError& error) {
    EXPECT_EQ(error.where(), "h04.gsf");
  }
}

TEST(ReduceOptions, NamesTheFirstOptionOutOfRange) {
  ReduceOptions spikes, margin, shift, gap;
  spikes.spike_threshold = 2.0;
  margin.rim_margin = -1.0 * um;
  shift.shift_uncertainty = -1.0 * um;
  gap.width.largest_gap = 0.0;
  const auto named = [](const ReduceOptions& options) -> std::string {
    try {
      options.validate();
    } catch (const InputError& error) {
      return error.where();
    }
    return "";
  };
  EXPECT_EQ(named({}), "");
  EXPECT_EQ(named(spikes), "--spike-threshold");
  EXPECT_EQ(named(margin), "--rim-margin");
  EXPECT_EQ(named(shift), "--shift-uncertainty");
  EXPECT_EQ(named(gap), "--largest-gap");
}

TEST(SubtractReference, RemovesTheInstrumentsOwnCurvature) {
  // A field curvature of 3 um that the rim's plane cannot take out.
  const auto curved = [](double x, double z) {
    return 3e-6 * (std::pow((x - 7.75e-3) / 8e-3, 2) + std::pow(z / 1.2e-3, 2));
  };
  const auto both = [&](double x, double z) { return kBulge(x, z) + curved(x, z); };
  RandomStream stream(61, "unused");
  MapErrors tilt;
  tilt.tilt_rows = 1e-4;
  const HeightMap map = test_support::synthetic_map(camera(), plain_frame(), both, tilt, stream);
  const HeightMap mirror = test_support::synthetic_map(camera(), plain_frame(), curved, {}, stream);
  const HeightMap flat = test_support::synthetic_map(camera(), plain_frame(), kBulge, {}, stream);
  const Array1 truth =
      reduce_map(flat, plain_frame(), {.height_noise = kNoise}, "flat").profile.zeta;
  const Array1 mended =
      reduce_map(subtract_reference(map, mirror, "m"), plain_frame(), {.height_noise = kNoise}, "m")
          .profile.zeta;
  EXPECT_LT((mended - truth).abs().maxCoeff(), 1e-14);  // round-off
  const Array1 raw = reduce_map(map, plain_frame(), {.height_noise = kNoise}, "m").profile.zeta;
  EXPECT_GT((raw - truth).abs().maxCoeff(), 1e-7);  // it would have mattered
}

TEST(SubtractReference, KeepsTheFlagsOfBothMaps) {
  const CameraGrid grid{3, 2, 1.0 * um, 1.0 * um};
  Flags2 a = Flags2::Zero(2, 3), b = Flags2::Zero(2, 3);
  a(0, 1) = PixelFlag::spike;
  b(1, 2) = PixelFlag::no_data;
  const HeightMap difference = subtract_reference({grid, Array2::Constant(2, 3, 5.0), a},
                                                  {grid, Array2::Constant(2, 3, 2.0), b}, "m");
  EXPECT_EQ(difference.flags()(0, 1), PixelFlag::spike);
  EXPECT_EQ(difference.flags()(1, 2), PixelFlag::no_data);
  EXPECT_EQ(difference.height()(0, 0), 3.0);
}

TEST(SubtractReference, RefusesAnotherGrid) {
  const CameraGrid grid{3, 2, 1.0 * um, 1.0 * um};
  for (const CameraGrid& other :
       {CameraGrid{2, 3, 1.0 * um, 1.0 * um}, CameraGrid{3, 2, 1.1 * um, 1.0 * um}}) {
    const HeightMap reference(other, Array2::Zero(other.ny, other.nx));
    EXPECT_THROW(subtract_reference({grid, Array2::Zero(2, 3)}, reference, "m"), InputError);
  }
}

}  // namespace
}  // namespace manoscope::maps
