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
    return read_channel_shape(folder_ / "shape.csv");
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

}  // namespace
}  // namespace manoscope::navier_stokes
