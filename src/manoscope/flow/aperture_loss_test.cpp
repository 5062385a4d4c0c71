#include "manoscope/flow/aperture_loss.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <numbers>
#include <utility>

#include "manoscope/core/arrays.hpp"
#include "manoscope/core/error.hpp"

namespace manoscope::flow {
namespace {

using std::numbers::pi;

/// Loss over eta Q of one side of a hole w = 1 by h, by boundary elements.
///
/// With u_z = phi - z d phi/dz and p = -2 eta d phi/dz of a harmonic phi that is zero on the plate,
/// the pressure in the hole is even where d phi/dz is: 1/(2 pi) f.p. int phi/r^3 dA = -1 and
/// loss/(eta Q) = 2/int phi dA. Constant elements, denser towards the edge; their error goes as
/// their size, which two meshes take out.
double by_elements(double h, Index n) {
  const auto node = [n](double side, Index i) {
    return 0.5 * side * std::sin(0.5 * pi * static_cast<double>(i) / static_cast<double>(n));
  };
  const auto corner = [](double x, double y) { return -std::hypot(x, y) / (x * y); };
  Matrix system = Matrix::Zero(n * n, n * n);
  Eigen::VectorXd area(n * n);
  for (Index j = 0; j < n * n; ++j) {
    const double x1 = node(1.0, j % n), x2 = node(1.0, j % n + 1);
    const double y1 = node(h, j / n), y2 = node(h, j / n + 1);
    area[j] = (x2 - x1) * (y2 - y1);
    for (Index i = 0; i < n * n; ++i) {
      const double at_x = 0.5 * (node(1.0, i % n) + node(1.0, i % n + 1));
      const double at_y = 0.5 * (node(h, i / n) + node(h, i / n + 1));
      for (const auto& [x, y] :
           {std::pair{at_x, at_y}, {at_x, -at_y}, {-at_x, at_y}, {-at_x, -at_y}}) {
        system(i, j) += (corner(x2 - x, y2 - y) - corner(x1 - x, y2 - y) - corner(x2 - x, y1 - y) +
                         corner(x1 - x, y1 - y)) /
                        (2.0 * pi);
      }
    }
  }
  const Eigen::VectorXd phi = system.partialPivLu().solve(-Eigen::VectorXd::Ones(n * n));
  return 2.0 / (4.0 * phi.dot(area));
}

double over_viscosity(double w, double h) {  // 1/m3
  return aperture_loss(1.0 * mPa_s, FlowRate::from_si(1e-9), w * mm, h * mm).si() / 1e-12 * 1e-9;
}

TEST(ApertureLoss, OfASquareIsHalfOfSampsonsForTheRoundHoleOfItsArea) {
  const double radius = 1.0 / std::sqrt(pi);
  EXPECT_NEAR(over_viscosity(1.0, 1.0) / (1.5 / std::pow(radius, 3)), 1.0, 1e-12);
}

TEST(ApertureLoss, OfALongSlitIsNearHasimotos) {
  // In the limit 3 sqrt(pi)/(16/pi) = 1.0440 for an ellipse in place of a rectangle.
  for (const double h : {0.175 / 1.7, 0.05, 1e-3}) {
    EXPECT_NEAR(over_viscosity(1.0, h) / (16.0 / (pi * h * h)), 1.0, 0.10) << h;
  }
  EXPECT_NEAR(over_viscosity(1.0, 1e-3) / (16.0 / (pi * 1e-6)), 1.0440, 1e-4);
}

TEST(ApertureLoss, StaysWithinItsStatedErrorOfTheRectangle) {
  for (const double h : {1.0, 0.5, 0.25, 0.175 / 1.7, 0.03}) {
    const double exact = 2.0 * by_elements(h, 20) - by_elements(h, 10);
    EXPECT_NEAR(over_viscosity(1.0, h) / exact, 1.0, 0.055) << h;
  }
}

TEST(ApertureLoss, DoesNotHangOnWhichSideIsCalledTheWidth) {
  EXPECT_EQ(over_viscosity(2.0, 0.5), over_viscosity(0.5, 2.0));
  EXPECT_THROW(over_viscosity(1.0, 0.0), InputError);
}

}  // namespace
}  // namespace manoscope::flow
