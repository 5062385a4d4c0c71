#include "channel_shape.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "manoscope/core/error.hpp"
#include "tests/support/temporary_folder.hpp"

namespace manoscope::navier_stokes {
namespace {

TEST(ChannelShape, IsExactForPolynomialsOfThirdDegree) {
  Array1 x(7), zeta(7);
  x << 0.0, 0.1, 0.25, 0.5, 0.55, 0.8, 1.0;
  const auto cubic = [](double s) { return 1.0 - 2.0 * s + 3.0 * s * s - 4.0 * s * s * s; };
  for (Index i = 0; i < x.size(); ++i) zeta[i] = cubic(x[i]);
  const ChannelShape shape(x, zeta);
  for (const double s : {0.0, 0.03, 0.1, 0.31, 0.77, 0.99, 1.0}) {
    EXPECT_NEAR(shape.value(s), cubic(s), 1e-14) << s;  // round-off
  }
}

TEST(ChannelShape, FollowsASmoothShapeInFourthOrder) {
  const auto error = [](Index n) {
    const Array1 x = Array1::LinSpaced(n, 0.0, 3.0);
    const ChannelShape shape(x, x.sin());
    double largest = 0.0;
    for (int i = 0; i <= 1000; ++i) {
      largest = std::max(largest, std::abs(shape.value(0.003 * i) - std::sin(0.003 * i)));
    }
    return largest;
  };
  EXPECT_GT(error(21) / error(41), 13.0);  // 16 for ever finer stations
}

TEST(ChannelShape, TwoStationsAreAStraightLine) {
  Array1 x(2), zeta(2);
  x << 1.0, 3.0;
  zeta << 2.0, 6.0;
  EXPECT_DOUBLE_EQ(ChannelShape(x, zeta).value(2.5), 5.0);
}

class ReadChannelShape : public testing::Test {
 protected:
  ChannelShape read(const std::string& text) const {
    std::ofstream(folder_ / "shape.csv") << text;
    const ShapeTable table = read_shape_table(folder_ / "shape.csv");
    EXPECT_FALSE(table.is_map());
    return {table.x, table.zeta.col(0)};
  }

 private:
  test_support::TemporaryFolder folder_;
};

TEST_F(ReadChannelShape, TakesTheUnitsOfTheHeader) {
  const ChannelShape shape = read("zeta [um],x [mm],note\n1,0,a\n3,2,b\n2,15.5,c\n");
  EXPECT_DOUBLE_EQ(shape.length(), 15.5e-3);
  EXPECT_DOUBLE_EQ(shape.zeta()[1], 3e-6);
  EXPECT_DOUBLE_EQ(shape.value(2e-3), 3e-6);
}

TEST_F(ReadChannelShape, NamesWhatIsWrong) {
  const auto message = [this](const std::string& text) {
    try {
      read(text);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_NE(message("x [mm],y [um]\n0,1\n1,1\n").find("no column \"zeta\""), std::string::npos);
  EXPECT_NE(message("x [mm],zeta\n0,1\n1,1\n").find("has the unit \"\""), std::string::npos);
  EXPECT_NE(message("x [mm],zeta [Pa]\n0,1\n1,1\n").find("\"Pa\""), std::string::npos);
  EXPECT_NE(message("x [mm],zeta [um]\n0,1\n1,one\n").find("shape.csv:3"), std::string::npos);
  EXPECT_NE(message("x [mm],zeta [um]\n1,1\n0,1\n").find("ascend"), std::string::npos);
  EXPECT_NE(message("x [mm],zeta [um]\n1,1\n").find("two stations"), std::string::npos);
}

TEST(ReadShapeTable, TakesAMapInAnyOrderOfItsRows) {
  const test_support::TemporaryFolder folder;
  const auto read = [&](const std::string& text) {
    std::ofstream(folder / "map.csv") << text;
    return read_shape_table(folder / "map.csv");
  };
  const ShapeTable map =
      read("z [mm],x [mm],zeta [um]\n0,0,1\n0,1,2\n0.5,1,4\n0.5,0,3\n-0.5,0,5\n-0.5,1,6\n");
  ASSERT_TRUE(map.is_map());
  ASSERT_EQ(map.zeta.rows(), 2);
  ASSERT_EQ(map.zeta.cols(), 3);
  EXPECT_DOUBLE_EQ(map.z[0], -0.5e-3);
  EXPECT_DOUBLE_EQ(map.zeta(0, 0), 5e-6);
  EXPECT_DOUBLE_EQ(map.zeta(1, 2), 4e-6);
  // One number printed in two ways is one place.
  EXPECT_EQ(read("x [m],z [m],zeta [m]\n0.1,0,1\n0.10000000000000001,1,2\n").x.size(), 1);

  const auto message = [&](const std::string& text) {
    try {
      read(text);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  const std::string head = "x [mm],z [mm],zeta [um]\n";
  EXPECT_NE(message(head + "0,0,1\n0,1,1\n1,0,1\n").find("no row at x = 1 mm, z = 1 mm"),
            std::string::npos);
  EXPECT_NE(message(head + "0,0,1\n0,1,1\n0,0,2\n").find("two rows at x = 0 mm, z = 0 mm"),
            std::string::npos);
  std::string scattered = head;
  for (int i = 0; i < 40; ++i) scattered += std::to_string(i) + "," + std::to_string(i) + ",1\n";
  EXPECT_NE(message(scattered).find("no grid"), std::string::npos);
  EXPECT_NE(message(head).find("no row"), std::string::npos);
  EXPECT_NE(message("x [mm],z,zeta [um]\n0,0,1\n").find("column \"z\""), std::string::npos);
}

}  // namespace
}  // namespace manoscope::navier_stokes
