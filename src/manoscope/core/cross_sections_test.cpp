#include "manoscope/core/cross_sections.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "manoscope/core/flags.hpp"

namespace manoscope {
namespace {

CrossSections cells(double first_x, double zeta) {
  const Index n_z = 3, n_x = 2;
  return {Array1::LinSpaced(n_x, first_x, first_x + 1.0), Array1::LinSpaced(n_z, -1.0, 1.0),
          Array2::Constant(n_z, n_x, zeta), Array2::Constant(n_z, n_x, 3.0),
          Flags2::Zero(n_z, n_x)};
}

TEST(MeanSections, OfRepeatsCountsTheGoodCells) {
  CrossSections first = cells(0.0, 4.0), second = cells(0.5, 8.0);
  first.flags(1, 0) = second.flags(1, 0) = PixelFlag::no_data;
  second.flags(2, 1) = PixelFlag::no_data;
  const CrossSections mean = mean_sections({first, CrossSections{}, second});
  EXPECT_DOUBLE_EQ(mean.x[0], 0.25);
  EXPECT_DOUBLE_EQ(mean.zeta(0, 0), 6.0);
  EXPECT_DOUBLE_EQ(mean.sigma(0, 0), 3.0 / std::sqrt(2.0));  // independent from map to map
  EXPECT_DOUBLE_EQ(mean.zeta(2, 1), 4.0);
  EXPECT_DOUBLE_EQ(mean.sigma(2, 1), 3.0);
  EXPECT_NE(mean.flags(1, 0), 0);
  EXPECT_EQ(mean.flags(0, 0), 0);
}

TEST(MeanSections, OfMapsTooCoarseForCellsIsEmpty) {
  EXPECT_TRUE(mean_sections({CrossSections{}}).empty());
}

}  // namespace
}  // namespace manoscope
