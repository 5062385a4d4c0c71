#include "manoscope/maps/deflection_picture.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "manoscope/core/flags.hpp"
#include "manoscope/core/random.hpp"

namespace manoscope::maps {
namespace {

constexpr double kNoise = 20e-9;
const ChannelGrid kGrid{70, 31, 15.0 * um, 16.0 * um, -30.0 * um, -240.0 * um};

/// A bulge of 40 um with noise; some pixels do not count.
DeflectionMap noisy_map(double noise) {
  RandomStream stream(7, "picture");
  Array2 zeta(kGrid.nz, kGrid.nx);
  Flags2 flags = Flags2::Zero(kGrid.nz, kGrid.nx);
  for (Index iz = 0; iz < kGrid.nz; ++iz) {
    for (Index ix = 0; ix < kGrid.nx; ++ix) {
      zeta(iz, ix) = 40e-6 * std::cos(0.1 * static_cast<double>(iz - 15)) + noise * stream.normal();
    }
  }
  flags.block(3, 5, 4, 6).setConstant(PixelFlag::spike);
  return {kGrid, zeta, flags, Length::from_si(noise)};
}

TEST(DeflectionPicture, IsWithinHalfAStepOfEveryPixelThatCounts) {
  const DeflectionMap map = noisy_map(kNoise);
  const MapPicture picture = picture_deflection(map, kGrid.nx * kGrid.nz);
  EXPECT_DOUBLE_EQ(picture.step, 0.5 * kNoise);
  ASSERT_EQ(picture.counts.rows(), kGrid.nz);
  ASSERT_EQ(picture.counts.cols(), kGrid.nx);
  for (Index iz = 0; iz < kGrid.nz; ++iz) {
    EXPECT_DOUBLE_EQ(picture.z[iz], kGrid.z(iz));
    for (Index ix = 0; ix < kGrid.nx; ++ix) {
      const auto count = picture.counts(iz, ix);
      if (map.flags()(iz, ix) != 0) {
        EXPECT_EQ(count, MapPicture::kMissing);
        continue;
      }
      // Half a step, and the round-off of 40 um in doubles.
      EXPECT_NEAR(count * picture.step, map.zeta()(iz, ix), 0.5 * picture.step + 1e-20);
    }
  }
  EXPECT_DOUBLE_EQ(picture.x[1], kGrid.x(1));
}

TEST(DeflectionPicture, TakesMeansOverCellsWhereTheMapIsLarge) {
  const DeflectionMap map = noisy_map(kNoise);
  const MapPicture picture = picture_deflection(map, 300);  // cells of 3 by 3: 24 x 11
  ASSERT_EQ(picture.x.size(), 24);
  ASSERT_EQ(picture.z.size(), 11);
  EXPECT_DOUBLE_EQ(picture.x[0], kGrid.x(1));
  EXPECT_DOUBLE_EQ(picture.x[23], kGrid.x(69));  // one pixel is left for the last cell
  const double mean = map.zeta().block(12, 30, 3, 3).mean();
  EXPECT_NEAR(picture.counts(4, 10) * picture.step, mean, 0.5 * picture.step + 1e-20);
  // Rows 3 to 5 and columns 6 to 8 do not count at all.
  EXPECT_EQ(picture.counts(1, 2), MapPicture::kMissing);
}

TEST(DeflectionPicture, OfAMapWithoutNoiseUsesTheWholeRange) {
  const DeflectionMap map = noisy_map(0.0);
  const MapPicture picture = picture_deflection(map, kGrid.nx * kGrid.nz);
  EXPECT_LE(picture.counts.maxCoeff(), MapPicture::kLargest);
  EXPECT_GT(picture.counts.maxCoeff(), MapPicture::kLargest - 3);
}

TEST(DeflectionPicture, OfAFlatMapIsFlat) {
  const DeflectionMap flat(kGrid, Array2::Zero(kGrid.nz, kGrid.nx),
                           Flags2::Zero(kGrid.nz, kGrid.nx), Length{});
  const MapPicture picture = picture_deflection(flat, 100);
  EXPECT_GT(picture.step, 0.0);
  EXPECT_TRUE((picture.counts == 0).all());
}

}  // namespace
}  // namespace manoscope::maps
