#include "manoscope/maps/region.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "manoscope/core/error.hpp"
#include "tests/support/synthetic_map.hpp"

namespace manoscope::maps {
namespace {

using test_support::Bulge;
using test_support::channel_from_camera;
using test_support::frame_at;
using test_support::MapErrors;

constexpr FlowDirection kDirections[] = {FlowDirection::plus_columns, FlowDirection::minus_columns,
                                         FlowDirection::plus_rows, FlowDirection::minus_rows};
constexpr Length kLength = 15.5 * mm, kWidth = 1.7 * mm;

/// A vented wall, one under 2 kPa, and one under flow, seen through one frame.
struct Scene {
  ChannelFrame frame;
  CameraGrid camera;
  HeightMap low, high, flowing;

  RegionMaps still() const { return {&low, &high, nullptr}; }
  RegionMaps all() const { return {&low, &high, &flowing}; }
  KnownPlace size_only() const {
    KnownPlace known;
    known.length = frame.length;
    known.width = frame.width;
    return known;
  }
};

/// 320 x 64 pixels of 53 x 50 um along and across the flow.
Scene make_scene(ChannelFrame frame, double low_crest = -1e-6, double high_crest = 20e-6,
                 MapErrors errors = {}) {
  CameraGrid camera{320, 64, 53.0 * um, 50.0 * um};
  if (!frame.along_columns()) {
    std::swap(camera.nx, camera.ny);
    std::swap(camera.pitch_x, camera.pitch_y);
  }
  if (errors.noise == 0.0) errors.noise = 20e-9;
  errors.dropouts = 0.03;
  if (errors.spikes == 0.0) errors.spikes = 0.002;
  if (errors.spike_size == 0.0) errors.spike_size = 1e-6;
  const double l = frame.length.si(), w = frame.width.si();
  const auto shoot = [&](double crest, double fall, std::uint64_t index) {
    RandomStream stream(51, "region", index);
    MapErrors own = errors;
    own.tilt_columns = stream.uniform(-3e-4, 3e-4);
    own.tilt_rows = stream.uniform(-3e-4, 3e-4);
    own.piston = stream.uniform(-1e-5, 1e-5);
    return test_support::synthetic_map(camera, frame, Bulge{l, w, crest, 0.54e-3, fall}, own,
                                       stream);
  };
  return {frame, camera, shoot(low_crest, 0.0, 0), shoot(high_crest, 0.0, 1),
          shoot(0.8 * high_crest, 0.9, 2)};
}

/// Largest distance, in pixels, between where two frames put the channel's corners and its middle.
double misplaced(const Scene& scene, const ChannelFrame& found) {
  double worst = 0.0;
  for (const double x : {0.0, 0.5 * kLength.si(), kLength.si()}) {
    for (const double z : {-0.5 * kWidth.si(), 0.5 * kWidth.si()}) {
      const auto [column, row] = found.camera_from_channel(x, z);
      auto at = channel_from_camera(scene.frame, column, row);
      if (found.across_reversed != scene.frame.across_reversed) at.z = -at.z;
      worst = std::max({worst, std::abs(at.x - x) / 53e-6, std::abs(at.z - z) / 50e-6});
    }
  }
  return worst;
}

std::string refusal(const RegionMaps& maps, const KnownPlace& known) {
  try {
    find_place(maps, known, "experiment.toml");
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(FindPlace, FindsTheChannelInEveryOrientationFromItsSizeAlone) {
  for (const FlowDirection flow : kDirections) {
    for (const bool reversed : {false, true}) {
      for (const Outward outward : {Outward::plus_height, Outward::minus_height}) {
        const bool columns =
            flow == FlowDirection::plus_columns || flow == FlowDirection::minus_columns;
        ChannelFrame frame =
            frame_at(kLength, kWidth, flow, reversed, columns ? 0.317 * mm : 0.613 * mm,
                     columns ? 0.613 * mm : 0.317 * mm);
        frame.outward = outward;
        const Scene scene = make_scene(frame);
        const FoundPlace found = find_place(scene.all(), scene.size_only(), "experiment.toml");
        EXPECT_EQ(found.frame.flow, flow);
        EXPECT_EQ(found.frame.outward, outward);
        EXPECT_EQ(found.frame.rotation, Angle{});
        // The feet of the row and column means are found to a fraction of a pixel, equally on both
        // sides, so that the middle is better still: 0.05 in the median, 0.2 at most over 240 other
        // draws.
        EXPECT_LT(misplaced(scene, found.frame), 0.5) << static_cast<int>(flow) << reversed;
        // Sides: the foot of a parabola, 0.6 pixel each. Ends: a taper over ten pixels.
        EXPECT_NEAR(found.width_misfit, 0.0, 2.0 * 50e-6);
        EXPECT_NEAR(found.length_misfit, 0.0, 4.0 * 53e-6);
      }
    }
  }
}

TEST(FindPlace, FindsASmallRotation) {
  for (const FlowDirection flow : kDirections) {
    for (const double milliradians : {5.0, -5.0, 15.0}) {
      const bool columns =
          flow == FlowDirection::plus_columns || flow == FlowDirection::minus_columns;
      ChannelFrame frame = frame_at(kLength, kWidth, flow, false, columns ? 0.7 * mm : 0.75 * mm,
                                    columns ? 0.75 * mm : 0.7 * mm);
      frame.rotation = Angle::from_si(milliradians * 1e-3);
      // Turn about the middle, so that the channel stays within the map.
      const auto [column, row] = frame.camera_from_channel(0.5 * kLength.si(), 0.0);
      frame.origin_x += Length::from_si((columns ? 320.0 * 53e-6 : 64.0 * 50e-6) / 2.0 - column);
      frame.origin_y += Length::from_si((columns ? 64.0 * 50e-6 : 320.0 * 53e-6) / 2.0 - row);
      const Scene scene = make_scene(frame);
      const FoundPlace found = find_place(scene.all(), scene.size_only(), "experiment.toml");
      EXPECT_EQ(found.frame.flow, flow);
      // Twelve blocks of 20 columns place the middle line to 0.1 pixel each: the slope over 12 mm
      // to 0.1 * 50 um / (12 mm / sqrt(12) * sqrt(12)) = 0.4 mrad; 0.17 in
      // the median and 0.64 at most over 180 other draws.
      EXPECT_NEAR(found.frame.rotation.si(), milliradians * 1e-3, 0.8e-3);
      EXPECT_LT(misplaced(scene, found.frame), 1.0) << milliradians;
    }
  }
}

TEST(FindPlace, TakesWhatIsGivenAsGiven) {
  const ChannelFrame frame =
      frame_at(kLength, kWidth, FlowDirection::minus_columns, false, 0.5 * mm, 0.7 * mm);
  const Scene scene = make_scene(frame);
  KnownPlace known = scene.size_only();
  known.origin = {{frame.origin_x + 3.0 * um, frame.origin_y}};
  known.flow = frame.flow;
  known.rotation = Angle{};
  known.outward = Outward::minus_height;  // wrong, but not ours to mend
  const FoundPlace found = find_place(scene.all(), known, "experiment.toml");
  EXPECT_EQ(found.frame.origin_x, frame.origin_x + 3.0 * um);
  EXPECT_EQ(found.frame.origin_y, frame.origin_y);
  EXPECT_EQ(found.frame.flow, frame.flow);
  EXPECT_EQ(found.frame.outward, Outward::minus_height);
  EXPECT_TRUE(std::isnan(found.length_misfit));
  EXPECT_TRUE(std::isnan(found.width_misfit));
}

TEST(FindPlace, TellsHowFarTheWallLiesFromAGivenPlace) {
  for (const FlowDirection flow : kDirections) {
    for (const bool across_reversed : {false, true}) {
      const Scene scene =
          make_scene(frame_at(kLength, kWidth, flow, across_reversed, 0.75 * mm, 0.7 * mm));
      const bool along_columns = scene.frame.along_columns();
      for (const auto& [along_mm, across_mm] :
           {std::pair{0.0, 0.0}, std::pair{0.4, 0.0}, std::pair{-0.3, 0.25}}) {
        // The given place lies that much off, so that the wall lies off it the other way.
        KnownPlace known = scene.size_only();
        const double along = scene.frame.flow_sign() * along_mm;
        const double across = scene.frame.across_sign() * across_mm;
        known.origin = {{scene.frame.origin_x + (along_columns ? along : across) * mm,
                         scene.frame.origin_y + (along_columns ? across : along) * mm}};
        known.flow = flow;
        known.outward = Outward::plus_height;
        const FoundPlace found = find_place(scene.still(), known, "m");
        if (found.frame.across_reversed != across_reversed) continue;  // both sides would fit
        // The ends are found to a pixel of 53 um each.
        EXPECT_NEAR(found.along_misfit, -along_mm * 1e-3, 53e-6);
        EXPECT_NEAR(found.across_misfit, -across_mm * 1e-3, 50e-6);
      }
    }
  }
}

TEST(FindPlace, SettlesTheSideToWhichTheChannelExtendsFromItsOrigin) {
  for (const FlowDirection flow : kDirections) {
    for (const bool reversed : {false, true}) {
      const bool columns =
          flow == FlowDirection::plus_columns || flow == FlowDirection::minus_columns;
      const ChannelFrame frame =
          frame_at(kLength, kWidth, flow, reversed, columns ? 0.5 * mm : 0.7 * mm,
                   columns ? 0.7 * mm : 0.5 * mm);
      const Scene scene = make_scene(frame);
      KnownPlace known = scene.size_only();
      known.origin = {{frame.origin_x, frame.origin_y}};
      known.flow = flow;
      EXPECT_EQ(find_place(scene.still(), known, "e").frame.across_reversed, reversed);
    }
  }
}

TEST(FindPlace, SettlesTheSideByResponseWhereBothWouldFit) {
  for (const bool reversed : {false, true}) {
    // A narrow channel in the middle of a tall map: both sides of its origin lie within the map.
    const ChannelFrame frame =
        frame_at(kLength, 0.9 * mm, FlowDirection::plus_columns, reversed, 0.5 * mm, 1.2 * mm);
    const Scene scene = make_scene(frame);
    KnownPlace known = scene.size_only();
    known.origin = {{frame.origin_x, frame.origin_y}};
    known.flow = frame.flow;
    EXPECT_EQ(find_place(scene.still(), known, "e").frame.across_reversed, reversed);
  }
}

TEST(FindPlace, ReadsTheFlowDirectionOffAGivenOrigin) {
  // The origin is the inlet's corner: at the far end of the map the flow can only run back, with or
  // without a map under flow.
  for (const FlowDirection flow : kDirections) {
    const bool columns =
        flow == FlowDirection::plus_columns || flow == FlowDirection::minus_columns;
    const ChannelFrame frame = frame_at(kLength, kWidth, flow, false, columns ? 0.5 * mm : 0.7 * mm,
                                        columns ? 0.7 * mm : 0.5 * mm);
    const Scene scene = make_scene(frame);
    KnownPlace known = scene.size_only();
    known.origin = {{frame.origin_x, frame.origin_y}};
    EXPECT_EQ(find_place(scene.still(), known, "e").frame.flow, flow);
    EXPECT_EQ(find_place(scene.all(), known, "e").frame.flow, flow);
  }
}

TEST(FindPlace, RefusesMapsInWhichNothingMoves) {
  const ChannelFrame frame =
      frame_at(kLength, kWidth, FlowDirection::plus_columns, false, 0.5 * mm, 0.7 * mm);
  const Scene scene = make_scene(frame, 0.0, 0.0);
  EXPECT_NE(refusal(scene.still(), scene.size_only()).find("no pixel answers to pressure"),
            std::string::npos);
}

TEST(FindPlace, IsNotFooledByOnePercentOfLargeSpikes) {
  const ChannelFrame frame =
      frame_at(kLength, kWidth, FlowDirection::plus_columns, false, 0.5 * mm, 0.7 * mm);
  MapErrors errors;
  errors.spikes = 0.01;
  errors.spike_size = 10e-6;
  const Scene still = make_scene(frame, 0.0, 0.0, errors);
  EXPECT_NE(refusal(still.still(), still.size_only()).find("no pixel answers to pressure"),
            std::string::npos);
  // Spikes five times the deflection: pairs and those beside dropouts remain, 1 in 1000 pixels.
  const Scene moving = make_scene(frame, 0.0, 2e-6, errors);
  const FoundPlace found = find_place(moving.all(), moving.size_only(), "e");
  EXPECT_EQ(found.frame.flow, frame.flow);
  EXPECT_LT(misplaced(moving, found.frame), 2.0);
}

TEST(FindPlace, RefusesAChannelThatDoesNotFit) {
  const ChannelFrame frame =
      frame_at(kLength, kWidth, FlowDirection::plus_columns, false, 0.5 * mm, 0.7 * mm);
  const Scene scene = make_scene(frame);
  KnownPlace known = scene.size_only();
  known.length = 25.0 * mm;
  EXPECT_NE(refusal(scene.still(), known).find("reaches beyond the map"), std::string::npos);
  known = scene.size_only();
  known.origin = {{5.0 * mm, 0.7 * mm}};
  known.flow = FlowDirection::plus_columns;
  EXPECT_NE(refusal(scene.still(), known).find("reaches beyond the map"), std::string::npos);
}

TEST(FindPlace, RefusesAChannelCutByTheBorderInsteadOfMisplacingIt) {
  for (const Length cut : {0.5 * mm, 1.0 * mm, 2.0 * mm}) {
    const ChannelFrame frame =
        frame_at(kLength, kWidth, FlowDirection::plus_columns, false, -cut, 0.7 * mm);
    const Scene scene = make_scene(frame);
    EXPECT_NE(refusal(scene.still(), scene.size_only()), "") << cut.in(mm);
  }
}

TEST(FindPlace, FindsAWeakResponseAndAStrongOne) {
  const ChannelFrame frame =
      frame_at(kLength, kWidth, FlowDirection::plus_columns, false, 0.5 * mm, 0.7 * mm);
  for (const double crest : {0.5e-6, 200e-6}) {
    const Scene scene = make_scene(frame, 0.0, crest);
    const FoundPlace found = find_place(scene.all(), scene.size_only(), "e");
    EXPECT_EQ(found.frame.flow, frame.flow);
    // The weak one stands 17 sigma above the noise at its crest, and its spikes twice as high.
    EXPECT_LT(misplaced(scene, found.frame), 1.0) << crest;
  }
}

}  // namespace
}  // namespace manoscope::maps
