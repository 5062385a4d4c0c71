#include "roof_map.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "manoscope/core/error.hpp"

namespace manoscope::navier_stokes {
namespace {

constexpr double kLength = 15.5e-3, kWidth = 1.7e-3;

/// Clamped at both sides, a little askew.
double roof(double x, double z) {
  const double s = 2.0 * z / kWidth;
  return 30e-6 * std::sin(x / 5e-3) * (1.0 - s * s) * (1.0 + 0.3 * s * s + 0.1 * s);
}

ShapeTable table(const Array1& z, Index n_x = 101) {
  ShapeTable map{Array1::LinSpaced(n_x, 0.0, kLength), z, Array2(n_x, z.size())};
  for (Index i = 0; i < n_x; ++i) {
    for (Index k = 0; k < z.size(); ++k) map.zeta(i, k) = roof(map.x[i], z[k]);
  }
  return map;
}

double largest_error(const RoofMap& map, const std::function<double(double, double)>& exact) {
  double largest = 0.0;
  for (int i = 0; i <= 100; ++i) {
    for (int k = -50; k <= 50; ++k) {
      const double x = kLength * i / 100.0 * 0.999, z = 0.01 * k * kWidth;
      largest = std::max(largest, std::abs(map.value(x, z) - exact(x, z)));
    }
  }
  return largest;
}

const Length kW = Length::from_si(kWidth);

TEST(RoofMap, FollowsASmoothRoofFromSideToSide) {
  const RoofMap map(table(Array1::LinSpaced(41, -0.5, 0.5) * kWidth), kW);
  EXPECT_LT(largest_error(map, roof), 2e-9);  // spacing^4
  const RoofMap finer(table(Array1::LinSpaced(81, -0.5, 0.5) * kWidth, 201), kW);
  EXPECT_GT(largest_error(map, roof) / largest_error(finer, roof), 12.0);  // 16 for ever finer
}

TEST(RoofMap, OfPixelsThatEndBeforeTheSidesIsClampedThere) {
  const double pixel = kWidth / 40.0;
  const RoofMap map(table(Array1::LinSpaced(40, -19.5 * pixel, 19.5 * pixel)), kW);
  EXPECT_DOUBLE_EQ(map.value(3e-3, 0.5 * kWidth), 0.0);
  EXPECT_DOUBLE_EQ(map.value(3e-3, -0.5 * kWidth), 0.0);
  EXPECT_LT(largest_error(map, roof), 5e-9);
  // Pixels on the rim are left out.
  const RoofMap wide(table(Array1::LinSpaced(60, -29.5 * pixel, 29.5 * pixel)), kW);
  EXPECT_DOUBLE_EQ(wide.value(3e-3, 0.2e-3), map.value(3e-3, 0.2e-3));
  EXPECT_EQ(wide.z().size(), 42);
}

TEST(RoofMap, CarriesTheNoiseOfTheRowsBesideTheSidesNoFartherThanThatOfOthers) {
  const double pixel = kWidth / 40.0;
  for (const double before_side : {0.01, 0.02, 0.1, 0.29, 0.31, 0.5, 0.9}) {
    const double last = 0.5 * kWidth - before_side * pixel;
    for (const bool half : {false, true}) {
      const Array1 z = half ? Array1::LinSpaced(20, last - 19.0 * pixel, last)
                            : Array1::LinSpaced(41, -last, last);
      const Index n = z.size();
      ShapeTable noisy{Array1::LinSpaced(5, 0.0, kLength), z, Array2::Zero(5, n)};
      noisy.zeta.col(n - 1).setOnes();
      if (!half) noisy.zeta.col(0).setOnes();
      // The worst of 1 in the last row: overshoots of a cubic in the middle of even rows are 1.0.
      const double gain = largest_error(RoofMap(noisy, kW), [](double, double) { return 0.0; });
      EXPECT_LT(gain, 1.3) << before_side << ' ' << half;
    }
    // Rows from -last to last are as far apart as 1.3 pixels at most: spacing^4.
    const RoofMap map(table(Array1::LinSpaced(41, -last, last)), kW);
    EXPECT_LT(largest_error(map, roof), 1.5e-8) << before_side;
  }
}

TEST(RoofMap, OfOneHalfIsMirrored) {
  const auto even = [](double x, double z) { return 0.5 * (roof(x, z) + roof(x, -z)); };
  for (const double first : {0.0, 0.01 * kWidth}) {
    ShapeTable half = table(Array1::LinSpaced(31, first, 0.5 * kWidth));
    for (Index i = 0; i < half.x.size(); ++i) {
      for (Index k = 0; k < half.z.size(); ++k) half.zeta(i, k) = even(half.x[i], half.z[k]);
    }
    const RoofMap map(half, kW);
    EXPECT_LT(largest_error(map, even), 5e-9);
    EXPECT_NEAR(map.odd(), 0.0, 1e-15);
  }
}

TEST(RoofMap, TellsMeanEvenAndOddPart) {
  const RoofMap map(table(Array1::LinSpaced(41, -0.5, 0.5) * kWidth), kW);
  const double x = 4e-3, crest = 30e-6 * std::sin(x / 5e-3);
  // Mean of (1 - s^2)(1 + 0.3 s^2): 2/3 + 0.3 (1/3 - 1/5).
  EXPECT_NEAR(map.mean().value(x), crest * (2.0 / 3.0 + 0.3 * 2.0 / 15.0), 2e-10);
  EXPECT_NEAR(map.even(x, 0.3e-3), 0.5 * (roof(x, 0.3e-3) + roof(x, -0.3e-3)), 2e-9);
  // Mean square of (1 - s^2) s is 8/105.
  double square = 0.0;
  for (const double at : map.x()) square += std::pow(std::sin(at / 5e-3), 2) / 101.0;
  EXPECT_NEAR(map.odd() / (3e-6 * std::sqrt(square * 8.0 / 105.0)), 1.0, 1e-3);
}

TEST(RoofMap, SaysWhatItCannotUse) {
  const auto message = [](const ShapeTable& map) {
    try {
      const RoofMap unused(map, kW);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  // z counted from one side.
  EXPECT_NE(message(table(Array1::LinSpaced(41, 0.0, kWidth))).find("from the middle"),
            std::string::npos);
  EXPECT_NE(message(table(Array1::LinSpaced(41, -0.3, 0.3) * kWidth)).find("from side to side"),
            std::string::npos);
  EXPECT_NE(message(table(Array1::LinSpaced(3, -0.5, 0.5) * kWidth)).find("four or more"),
            std::string::npos);
  EXPECT_NE(message(table(Array1::LinSpaced(41, -0.5, 0.5) * kWidth, 1)).find("two or more"),
            std::string::npos);
  ShapeTable broken = table(Array1::LinSpaced(41, -0.5, 0.5) * kWidth);
  broken.zeta(3, 3) = std::nan("");
  EXPECT_NE(message(broken).find("finite"), std::string::npos);
}

TEST(RoofMap, NamesThePlaceOfAClosedGap) {
  ShapeTable dented = table(Array1::LinSpaced(41, -0.5, 0.5) * kWidth);
  dented.zeta(40, 10) = -200e-6;
  const RoofMap map(dented, kW);
  require_open_gap(map, 201.0 * um);
  try {
    require_open_gap(map, 175.0 * um);
    FAIL() << "a closed gap counts as open";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("x = 6.2 mm, z = -0.425 mm"), std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace manoscope::navier_stokes
