#include "manoscope/twin/interferometer.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "manoscope/core/error.hpp"
#include "manoscope/twin/scenario.hpp"

namespace manoscope::twin {
namespace {

const flow::Channel kChannel{15.5 * mm, 1.7 * mm, 175.0 * um};

/// No error at all.
InterferometerOptions perfect() {
  InterferometerOptions options;
  options.n_along = 400;
  options.n_across = 100;
  options.noise = Length{};
  options.tilt = Angle{};
  options.piston = Length{};
  options.shift = Length{};
  options.dropouts = options.blobs = options.spikes = 0.0;
  return options;
}

/// Larger at the inlet than at the outlet, so that a reversed channel shows.
ChannelCurve some_deflection() {
  const Array1 x = Array1::LinSpaced(2001, 0.0, 15.5e-3);
  const Array1 wall = small_s1().tapered_membrane().deflection(x, 9.0 * kPa);
  return {kChannel.length, wall * (1.0 - 0.6 * x / 15.5e-3)};
}

ChannelCurve flat() { return {kChannel.length, Array1::Zero(8)}; }

double fraction_lost(const HeightMap& map) {
  return static_cast<double>((map.flags() != 0).count()) / static_cast<double>(map.flags().size());
}

TEST(Interferometer, WithoutErrorsShowsTheWallWhoseWidthAverageIsTheDeflection) {
  const ChannelCurve zeta = some_deflection();
  const InterferometerOptions options = perfect();
  const HeightMap map = record_map(kChannel, zeta, options, 1, 0);
  const double pitch_z = map.grid().pitch_y.si(), w = kChannel.width.si();
  for (Index ix = 0; ix < map.grid().nx; ++ix) {
    const double x = (static_cast<double>(ix) + 0.5) * map.grid().pitch_x.si() - 0.4e-3;
    const double average = map.height().col(ix).sum() * pitch_z / w;
    // Midpoint rule over a parabola that ends inside a pixel: at most (pitch/w)^2 at each edge,
    // where the parabola is within 6 pitch/w of its mean of zero.
    const double tolerance = 6.0 * std::pow(pitch_z / w, 2) * std::abs(zeta(x)) + 1e-18;
    EXPECT_NEAR(average, zeta(x), tolerance) << "x = " << x;
  }
  EXPECT_EQ((map.flags() != 0).count(), 0);
}

TEST(Interferometer, SeesARimAtRestAroundTheChannel) {
  const HeightMap map = record_map(kChannel, some_deflection(), perfect(), 1, 0);
  const Index rim_x = static_cast<Index>(0.4e-3 / map.grid().pitch_x.si());
  const Index rim_y = static_cast<Index>(0.4e-3 / map.grid().pitch_y.si());
  EXPECT_EQ(map.height().leftCols(rim_x).abs().maxCoeff(), 0.0);
  EXPECT_EQ(map.height().rightCols(rim_x).abs().maxCoeff(), 0.0);
  EXPECT_EQ(map.height().topRows(rim_y).abs().maxCoeff(), 0.0);
  EXPECT_EQ(map.height().bottomRows(rim_y).abs().maxCoeff(), 0.0);
  EXPECT_GT(map.height()(map.grid().ny / 2, map.grid().nx / 2), 20e-6);
}

TEST(Interferometer, PutsEveryChannelPointWhereItsFrameSays) {
  const ChannelCurve zeta = some_deflection();
  for (const FlowDirection flow : {FlowDirection::plus_columns, FlowDirection::minus_columns,
                                   FlowDirection::plus_rows, FlowDirection::minus_rows}) {
    for (const bool reversed : {false, true}) {
      InterferometerOptions options = perfect();
      options.flow = flow;
      options.across_reversed = reversed;
      options.outward = reversed ? Outward::minus_height : Outward::plus_height;
      const HeightMap map = record_map(kChannel, zeta, options, 1, 0);
      const ChannelFrame frame = channel_frame(kChannel, options);
      for (const double x : {0.7e-3, 4e-3, 14e-3}) {
        for (const double z : {-0.6e-3, 0.0, 0.3e-3}) {
          const auto [column, row] = frame.camera_from_channel(x, z);
          const auto ix = static_cast<Index>(column / map.grid().pitch_x.si());
          const auto iy = static_cast<Index>(row / map.grid().pitch_y.si());
          const double expected = 1.5 * zeta(x) * (1.0 - std::pow(z / 0.85e-3, 2));
          // The nearest pixel is at most half a pitch off: half of 42 um along x, where the end
          // layer climbs by zeta/0.54 mm, and of 25 um across, where the slope is 3 zeta/a.
          EXPECT_NEAR((reversed ? -1.0 : 1.0) * map.height()(iy, ix), expected,
                      0.12 * 25e-6 + 1e-12);
        }
      }
    }
  }
}

TEST(Interferometer, MirroredViewsHoldTheSameNumbers) {
  InterferometerOptions options = perfect();
  const HeightMap forth = record_map(kChannel, some_deflection(), options, 1, 0);
  options.flow = FlowDirection::minus_columns;
  const HeightMap back = record_map(kChannel, some_deflection(), options, 1, 0);
  EXPECT_LT((forth.height().rowwise().reverse() - back.height()).abs().maxCoeff(), 1e-15);
  options.flow = FlowDirection::plus_rows;
  const HeightMap turned = record_map(kChannel, some_deflection(), options, 1, 0);
  EXPECT_LT((forth.height().transpose() - turned.height()).abs().maxCoeff(), 1e-15);
}

TEST(Interferometer, TurnsTheChannelByItsRotation) {
  InterferometerOptions options = perfect();
  options.rotation = Angle::from_si(0.01);
  const HeightMap map = record_map(kChannel, some_deflection(), options, 1, 0);
  // On the centre line, 12 mm on, the channel has moved by 12 mm * sin(0.01) towards growing rows.
  const auto [column, row] = channel_frame(kChannel, options).camera_from_channel(12e-3, 0.0);
  EXPECT_NEAR(row, 0.4e-3 + 0.85e-3 * std::cos(0.01) + 12e-3 * std::sin(0.01), 1e-12);
  Index crest = 0;
  map.height().col(static_cast<Index>(column / map.grid().pitch_x.si())).maxCoeff(&crest);
  EXPECT_NEAR(static_cast<double>(crest) + 0.5, row / map.grid().pitch_y.si(), 1.0);  // a pixel
}

TEST(Interferometer, NoiseHasItsStandardDeviation) {
  InterferometerOptions options = perfect();
  options.noise = 20.0 * nm;
  const HeightMap map = record_map(kChannel, flat(), options, 5, 3);
  const double n = static_cast<double>(map.height().size());
  const double mean = map.height().mean();
  const double sd = std::sqrt((map.height() - mean).square().sum() / (n - 1.0));
  // Five standard errors of the mean and of the standard deviation of n normal numbers.
  EXPECT_NEAR(mean, 0.0, 5.0 * 20e-9 / std::sqrt(n));
  EXPECT_NEAR(sd, 20e-9, 5.0 * 20e-9 / std::sqrt(2.0 * n));
}

TEST(Interferometer, LosesTheFractionOfPixelsItIsToldTo) {
  InterferometerOptions options = perfect();
  options.dropouts = 0.02;
  const double n = 400.0 * 100.0;
  // Independent pixels: five standard deviations of the binomial law.
  EXPECT_NEAR(fraction_lost(record_map(kChannel, flat(), options, 5, 0)), 0.02,
              5.0 * std::sqrt(0.02 * 0.98 / n));
  options.dropouts = 0.0;
  options.blobs = 0.02;
  // About 40 blobs of 20 pixels a map, over 20 maps: sizes spread by half, and overlaps and the
  // map's edge take a few per cent.
  double lost = 0.0;
  for (std::uint64_t i = 0; i < 20; ++i) {
    lost += fraction_lost(record_map(kChannel, flat(), options, 5, i)) / 20.0;
  }
  EXPECT_NEAR(lost, 0.02, 0.02 * (0.05 + 5.0 * 0.5 / std::sqrt(20.0 * 40.0)));
}

TEST(Interferometer, FalsifiesTheFractionOfPixelsItIsToldTo) {
  InterferometerOptions options = perfect();
  options.spikes = 0.01;
  const HeightMap map = record_map(kChannel, flat(), options, 5, 0);
  const double n = static_cast<double>(map.height().size());
  const auto spikes = map.height().abs() > 0.99e-6;
  EXPECT_NEAR(static_cast<double>(spikes.count()) / n, 0.01, 5.0 * std::sqrt(0.01 * 0.99 / n));
  EXPECT_EQ((map.height() != 0.0).count(), spikes.count());
  EXPECT_LE(map.height().abs().maxCoeff(), 3e-6);
}

TEST(Interferometer, TiltsAndLiftsEachMapByItsOwnDraw) {
  InterferometerOptions options = perfect();
  options.tilt = Angle::from_si(1e-3);
  options.piston = 1.0 * um;
  double slope_square = 0.0, mean_square = 0.0;
  const int n = 400;
  options.n_along = 20;
  options.n_across = 8;
  for (int i = 0; i < n; ++i) {
    const HeightMap map = record_map(kChannel, flat(), options, 5, static_cast<std::uint64_t>(i));
    const Index nx = map.grid().nx;
    const double slope = (map.height()(0, nx - 1) - map.height()(0, 0)) /
                         (static_cast<double>(nx - 1) * map.grid().pitch_x.si());
    slope_square += slope * slope / n;
    mean_square += std::pow(map.height().mean(), 2) / n;
  }
  // Five standard errors of a variance from n draws.
  EXPECT_NEAR(slope_square / 1e-6, 1.0, 5.0 * std::sqrt(2.0 / n));
  EXPECT_NEAR(mean_square / 1e-12, 1.0, 5.0 * std::sqrt(2.0 / n));
}

TEST(Interferometer, OneErrorDoesNotMoveTheDrawsOfAnother) {
  InterferometerOptions noisy = perfect();
  noisy.noise = 20.0 * nm;
  InterferometerOptions all = noisy;
  all.dropouts = 0.1;
  const HeightMap a = record_map(kChannel, some_deflection(), noisy, 5, 0);
  const HeightMap b = record_map(kChannel, some_deflection(), all, 5, 0);
  EXPECT_TRUE((b.flags() != 0 || a.height() == b.height()).all());
}

TEST(Interferometer, ShiftMovesTheChannelOnly) {
  InterferometerOptions options = perfect();
  options.shift = 20.0 * um;
  const HeightMap still = record_map(kChannel, some_deflection(), perfect(), 5, 0);
  const HeightMap moved = record_map(kChannel, some_deflection(), options, 5, 0);
  EXPECT_GT((still.height() - moved.height()).abs().maxCoeff(), 1e-7);
  // Content is conserved: the same volume, up to the quadrature at the edges.
  EXPECT_NEAR(moved.height().sum() / still.height().sum(), 1.0, 2e-3);
}

TEST(Interferometer, ListsItsPixelStationsInsideTheChannel) {
  const Array1 x = pixel_stations(kChannel, perfect());
  EXPECT_GT(x(0), 0.0);
  EXPECT_LT(x(x.size() - 1), kChannel.length.si());
  const double pitch = 16.3e-3 / 400.0;
  EXPECT_NEAR(x(1) - x(0), pitch, 1e-15);
  EXPECT_LT(x(0), pitch);
  EXPECT_GT(x(x.size() - 1), kChannel.length.si() - pitch);
}

TEST(Interferometer, RefusesOptionsOutOfRangeByName) {
  const auto refused = [](auto change, const std::string& name) {
    InterferometerOptions options;
    change(options);
    try {
      options.validate();
      ADD_FAILURE() << name << " passed";
    } catch (const InputError& error) {
      EXPECT_NE(error.found().find(name), std::string::npos) << error.what();
    }
  };
  refused([](auto& o) { o.n_along = 2; }, "n_along");
  refused([](auto& o) { o.n_across = 100000; }, "n_across");
  refused([](auto& o) { o.noise = -1.0 * nm; }, "noise");
  refused([](auto& o) { o.dropouts = 0.7; }, "dropouts");
  refused([](auto& o) { o.rotation = 1.0 * rad; }, "rotation");
}

}  // namespace
}  // namespace manoscope::twin
