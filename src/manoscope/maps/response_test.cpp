#include "manoscope/maps/response.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "manoscope/core/error.hpp"
#include "tests/support/synthetic_map.hpp"

namespace manoscope::maps {
namespace {

using test_support::Bulge;
using test_support::MapErrors;

HeightMap map_of(double crest, double tilt, std::uint64_t index, double dropouts = 0.0) {
  const CameraGrid camera{200, 60, 60.0 * um, 50.0 * um};
  const ChannelFrame frame = test_support::frame_at(
      10.0 * mm, 1.7 * mm, FlowDirection::plus_columns, false, 1.0 * mm, 0.65 * mm);
  MapErrors errors;
  errors.noise = 20e-9;
  errors.tilt_columns = tilt;
  errors.tilt_rows = -2.0 * tilt;
  errors.piston = 3e-6;
  errors.dropouts = dropouts;
  RandomStream stream(41, "response", index);
  return test_support::synthetic_map(camera, frame, Bulge{10e-3, 1.7e-3, crest}, errors, stream);
}

TEST(WallResponse, IsWhatTheWallDidWhateverEachMapsTilt) {
  const Response response =
      wall_response(map_of(2e-6, 1e-4, 0, 0.02), map_of(12e-6, -3e-4, 1, 0.02), "experiment");
  EXPECT_NEAR(response.sigma, std::sqrt(2.0) * 20e-9, 0.1 * 28e-9);  // two maps; 2000 border pixels
  const ChannelFrame frame = test_support::frame_at(
      10.0 * mm, 1.7 * mm, FlowDirection::plus_columns, false, 1.0 * mm, 0.65 * mm);
  const Bulge moved{10e-3, 1.7e-3, 10e-6};
  Index bad = 0;
  for (Index iy = 0; iy < 60; ++iy) {
    for (Index ix = 0; ix < 200; ++ix) {
      if (response.good(iy, ix) == 0) {
        EXPECT_EQ(response.height(iy, ix), 0.0);
        ++bad;
        continue;
      }
      const auto at = test_support::channel_from_camera(
          frame, (static_cast<double>(ix) + 0.5) * 60e-6, (static_cast<double>(iy) + 0.5) * 50e-6);
      // 5.5 sigma of the difference, for 12000 pixels, and 1 % for the plane; beside a dropout the
      // cure for spikes may take the height of the next pixel in the row.
      const bool alone =
          ix > 0 && ix < 199 && (response.good(iy, ix - 1) == 0 || response.good(iy, ix + 1) == 0);
      const double rise = std::max(std::abs(moved(at.x + 60e-6, at.z) - moved(at.x, at.z)),
                                   std::abs(moved(at.x - 60e-6, at.z) - moved(at.x, at.z)));
      EXPECT_NEAR(response.height(iy, ix), moved(at.x, at.z),
                  5.5 * 28.3e-9 * 1.01 + (alone ? rise : 0.0));
    }
  }
  EXPECT_NEAR(static_cast<double>(bad) / 12000.0, 1.0 - 0.98 * 0.98, 4.0 * 0.0018);
  EXPECT_NEAR(response.top, 10e-6, 0.1e-6);  // 0.5 % of all pixels lie within 1 % of the crest
}

TEST(WallResponse, CutsLoneSpikesDownToTheirNeighbours) {
  Array2 height = Array2::Zero(60, 200);
  height(30, 100) = 1e-5;
  height(30, 104) = -1e-5;
  height.block(20, 150, 3, 3).setConstant(2e-6);  // no lone spike: it stays
  const CameraGrid camera{200, 60, 60.0 * um, 50.0 * um};
  const Response response =
      wall_response({camera, Array2::Zero(60, 200)}, {camera, height}, "experiment");
  EXPECT_EQ(response.height(30, 100), 0.0);
  EXPECT_EQ(response.height(30, 104), 0.0);
  EXPECT_EQ(response.height(21, 151), 2e-6);
  EXPECT_EQ(response.top, 0.0);  // nine of 12000 pixels are no wall
}

TEST(WallResponse, RefusesMapsOfDifferentCamerasAndABorderWithoutData) {
  const HeightMap map = map_of(0.0, 0.0, 0);
  const HeightMap other({200, 60, 61.0 * um, 50.0 * um}, Array2::Zero(60, 200));
  EXPECT_THROW(wall_response(map, other, "experiment"), InputError);
  Array2 height = Array2::Constant(60, 200, std::numeric_limits<double>::quiet_NaN());
  EXPECT_THROW(wall_response(map, {map.grid(), height}, "experiment"), InputError);
  height.block(10, 20, 40, 160).setZero();
  EXPECT_THROW(wall_response(map, {map.grid(), height}, "experiment"), InputError);
}

TEST(ExtentOf, FindsTheEndsOfATrapezoidAndOfAParabola) {
  for (const double shift : {0.0, 0.3, 0.77}) {
    Array1 trapezoid(200), parabola(200);
    for (Index i = 0; i < 200; ++i) {
      const double x = static_cast<double>(i) - shift;
      trapezoid[i] = std::clamp(std::min(x - 40.0, 160.0 - x) / 20.0, 0.0, 1.0);
      parabola[i] = std::max(0.0, 1.0 - std::pow((x - 100.0) / 60.0, 2));
    }
    const Extent straight = extent_of(trapezoid), curved = extent_of(parabola);
    ASSERT_TRUE(straight.found && curved.found);
    // Flanks are straight between 10 and 30 %; the mean of five pixels rounds the foot, 2 pixels
    // from 10 %, by up to 1/25 of a pixel's rise there: 0.1 pixel.
    EXPECT_NEAR(straight.first, 40.0 + shift, 0.1);
    EXPECT_NEAR(straight.last, 160.0 + shift, 0.1);
    // 1 - u^2 = 0.1 at u = 0.949, 0.3 at 0.837: the chord meets zero at 1.005, 0.3 pixel outside,
    // and the mean over five pixels lifts the foot by as much again.
    EXPECT_NEAR(curved.first, 40.0 + shift, 0.7);
    EXPECT_NEAR(curved.last, 160.0 + shift, 0.7);
    EXPECT_NEAR(0.5 * (curved.first + curved.last), 100.0 + shift, 0.05);  // symmetric
  }
}

TEST(ExtentOf, FindsNothingWhereNothingStandsUp) {
  EXPECT_FALSE(extent_of(Array1::Zero(100)).found);
  EXPECT_FALSE(extent_of(Array1::Constant(100, -1.0)).found);
  EXPECT_FALSE(extent_of(Array1::Ones(4)).found);
}

}  // namespace
}  // namespace manoscope::maps
