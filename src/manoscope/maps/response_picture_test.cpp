#include "manoscope/maps/response_picture.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "manoscope/core/error.hpp"
#include "tests/support/synthetic_map.hpp"

namespace manoscope::maps {
namespace {

using test_support::Bulge;
using test_support::MapErrors;

const CameraGrid kCamera{520, 100, 31.2 * um, 15.6 * um};
const ChannelFrame kFrame = test_support::frame_at(
    15.5 * mm, 1.0 * mm, FlowDirection::minus_columns, true, 0.3 * mm, 0.25 * mm);

HeightMap wall_map(double crest, double tilt) {
  MapErrors errors;
  errors.tilt_columns = tilt;
  RandomStream stream(41, "picture");
  return test_support::synthetic_map(kCamera, kFrame, Bulge{15.5e-3, 1.0e-3, crest, 0.4e-3, 0.3},
                                     errors, stream);
}

TEST(ResponsePicture, ShowsTheDifferenceOfTwoStatesInTheChannelsFrame) {
  const ResponsePicture picture =
      picture_response(wall_map(2e-6, 1e-5), wall_map(20e-6, -1e-5), kFrame, "map");
  EXPECT_LE(picture.x.size(), 256);
  EXPECT_LE(picture.z.size(), 96);
  const Bulge moved{15.5e-3, 1.0e-3, 18e-6, 0.4e-3, 0.3};
  for (Index iz = 0; iz < picture.z.size(); ++iz) {
    for (Index ix = 0; ix < picture.x.size(); ++ix) {
      // Mean over cells of 94 x 31 um: a kink of 0.07 m/m at the sides, 0.045 at the ends, moves
      // it by an eighth of the cell times the kink.
      EXPECT_NEAR(picture.height(iz, ix), moved(picture.x[ix], picture.z[iz]), 0.8e-6);
    }
  }
}

TEST(ResponsePicture, LeavesCellsWithoutPixelsEmpty) {
  Array2 height = wall_map(0.0, 0.0).height();
  height.block(40, 200, 12, 12).setConstant(std::numeric_limits<double>::quiet_NaN());
  const ResponsePicture picture =
      picture_response({kCamera, height}, wall_map(20e-6, 0.0), kFrame, "map");
  EXPECT_GT(picture.height.isNaN().count(), 8);
  EXPECT_LT(picture.height.isNaN().count(), 40);
}

TEST(ResponsePicture, WantsTwoMapsOfOneCamera) {
  const HeightMap small({8, 8, 1.0 * um, 1.0 * um}, Array2::Zero(8, 8));
  EXPECT_THROW(picture_response(small, wall_map(1e-6, 0.0), kFrame, "map"), InputError);
}

}  // namespace
}  // namespace manoscope::maps
