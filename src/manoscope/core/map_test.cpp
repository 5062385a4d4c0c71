#include <gtest/gtest.h>

#include <limits>

#include "manoscope/core/deflection_map.hpp"
#include "manoscope/core/error.hpp"
#include "manoscope/core/flags.hpp"
#include "manoscope/core/height_map.hpp"

namespace manoscope {
namespace {

TEST(HeightMap, FlagsEveryHeightThatIsNotFinite) {
  Array2 height = Array2::Constant(2, 3, 1e-6);
  height(0, 1) = std::numeric_limits<double>::quiet_NaN();
  height(1, 2) = std::numeric_limits<double>::infinity();
  const HeightMap map(CameraGrid{3, 2, 10.0 * um, 12.0 * um}, height);
  EXPECT_EQ(map.flags()(0, 1), PixelFlag::no_data);
  EXPECT_EQ(map.flags()(1, 2), PixelFlag::no_data);
  EXPECT_EQ(map.flags().cast<int>().sum(), 2 * PixelFlag::no_data);
  EXPECT_TRUE(map.height().isFinite().all());
}

TEST(Maps, RefuseAShapeThatDiffersFromTheirGrid) {
  EXPECT_THROW(HeightMap(CameraGrid{3, 2, 1.0 * um, 1.0 * um}, Array2::Zero(3, 2)), InternalError);
  EXPECT_THROW(DeflectionMap(ChannelGrid{3, 2, 1.0 * um, 1.0 * um}, Array2::Zero(2, 3),
                             Flags2::Zero(3, 3), 20.0 * nm),
               InternalError);
}

TEST(ChannelGrid, CountsFromItsOrigin) {
  const ChannelGrid grid{4, 3, 10.0 * um, 5.0 * um, -15.0 * um, -5.0 * um};
  EXPECT_DOUBLE_EQ(grid.x(2), 5e-6);
  EXPECT_DOUBLE_EQ(grid.z(1), 0.0);
}

}  // namespace
}  // namespace manoscope
