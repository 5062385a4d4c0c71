#include "manoscope/io/point_grid.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "manoscope/io/test_files.hpp"

namespace manoscope::io {
namespace {

using testing::complaint;
using testing::contains;

struct Points {
  std::vector<double> x, y, z;
  void add(double px, double py, double pz) {
    x.push_back(px);
    y.push_back(py);
    z.push_back(pz);
  }
  PointGrid grid() const { return grid_of_points(x, y, z, "p.txt"); }
  std::string fault() const {
    return complaint([&] { static_cast<void>(grid()); });
  }
};

TEST(PointGrid, PutsPointsInAnyOrderOnTheirGrid) {
  Points points;
  points.add(20, 5, 6);
  points.add(10, 4, 2);
  points.add(0, 4, 1);
  points.add(0, 5, 4);
  points.add(20, 4, 3);  // (10, 5) is absent
  const PointGrid grid = points.grid();
  EXPECT_EQ(grid.pitch_x, 10.0);
  EXPECT_EQ(grid.pitch_y, 1.0);
  EXPECT_EQ(grid.x0, 0.0);
  EXPECT_EQ(grid.y0, 4.0);
  EXPECT_TRUE((grid.values.row(0) == Eigen::Array3d(1, 2, 3).transpose()).all());
  EXPECT_EQ(grid.values(1, 0), 4.0);
  EXPECT_TRUE(std::isnan(grid.values(1, 1)));
  EXPECT_EQ(grid.values(1, 2), 6.0);
}

TEST(PointGrid, WholeRowsMayBeAbsent) {
  Points points;
  for (const double y : {0.0, 1.0, 2.0, 4.0}) {
    for (int ix = 0; ix < 5; ++ix) points.add(ix, y, y);
  }
  const PointGrid grid = points.grid();
  EXPECT_EQ(grid.values.rows(), 5);
  EXPECT_TRUE(std::isnan(grid.values(3, 0)));
}

TEST(PointGrid, RoundedCoordinatesAreForgiven) {
  Points points;
  for (int iy = 0; iy < 40; ++iy) {
    for (int ix = 0; ix < 300; ++ix) {
      points.add(std::round(ix * 1.63458 * 100) / 100, std::round(iy * 0.7777 * 100) / 100,
                 ix + iy);
    }
  }
  const PointGrid grid = points.grid();
  EXPECT_EQ(grid.values.cols(), 300);
  EXPECT_EQ(grid.values.rows(), 40);
  // Half a digit at either end, over 299 and 39 steps.
  EXPECT_NEAR(grid.pitch_x, 1.63458, 0.01 / 299);
  EXPECT_NEAR(grid.pitch_y, 0.7777, 0.01 / 39);
  EXPECT_EQ(grid.values(39, 299), 338.0);
}

TEST(PointGrid, ScatteredDoubledAndSparsePointsAreRefused) {
  Points scattered;
  for (int i = 0; i < 50; ++i) {
    scattered.add(std::fmod(i * 0.6180339887, 1.0), std::fmod(i * 0.7548776662, 1.0), i);
  }
  EXPECT_TRUE(contains(scattered.fault(), "p.txt"));
  EXPECT_TRUE(contains(scattered.fault(), "resample"));
  Points doubled;
  for (const int x : {0, 1, 2, 1}) doubled.add(x, 0, 0);
  EXPECT_TRUE(contains(doubled.fault(), "two points lie at x = 1"));
  Points diagonal;
  for (int i = 0; i < 1000; ++i) diagonal.add(i, i, 0);
  EXPECT_TRUE(contains(diagonal.fault(), "by less than a quarter"));
  Points lost;
  lost.add(std::numeric_limits<double>::quiet_NaN(), 0, 0);
  EXPECT_TRUE(contains(lost.fault(), "lacks its position"));
}

TEST(PointGrid, EvenSpacingOfAList) {
  EXPECT_NEAR(even_spacing(std::vector<double>{0.0386, 0.0772, 0.1158, 0.1544, 0.1931}, "p"),
              0.038625, 1e-12);
  EXPECT_EQ(even_spacing(std::vector<double>{3, 2, 1}, "p"), -1.0);
  EXPECT_THROW(even_spacing(std::vector<double>{0, 1, 2, 4}, "p"), InputError);
  EXPECT_THROW(even_spacing(std::vector<double>{1, 1, 1}, "p"), InputError);
}

}  // namespace
}  // namespace manoscope::io
