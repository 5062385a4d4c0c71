#include "manoscope/inversion/repeats.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "manoscope/core/random.hpp"
#include "manoscope/numerics/chi_square.hpp"
#include "tests/support/local_wall.hpp"

namespace manoscope::inversion {
namespace {

constexpr double kPixel = 3e-9, kOffset = 2e-9, kTilt = 2e-9;  // m
constexpr double kCompliance = 1.5e-9;                         // m/Pa
const Stretch kStretch{1.6 * mm, 13.9 * mm};

/// Maps of one state with errors of their own and one that all share.
std::vector<Profile> seen(RandomStream& random, int n, double label = 0.0) {
  std::vector<Profile> maps;
  for (int i = 0; i < n; ++i) {
    const std::string name = "f" + std::to_string(i);
    Profile map = test::exact_profile(Array1::LinSpaced(120, 0.2e-3, 15.3e-3),
                                      [](double x) { return 20e-6 - 1e-3 * x; });
    const Index n_x = map.x.size();
    map.zeta += label * random.normal() * kCompliance;
    map.uncertainty.independent.setConstant(kPixel);
    for (double& zeta : map.zeta) zeta += kPixel * random.normal();
    for (const Array1& effect :
         {Array1(Array1::Constant(n_x, kOffset)), Array1(Array1::LinSpaced(n_x, -kTilt, kTilt))}) {
      map.zeta += effect * random.normal();
      map.uncertainty.modes.push_back(
          {"plane " + std::to_string(map.uncertainty.modes.size()) + " of " + name, "leveling",
           effect});
    }
    map.uncertainty.modes.push_back({"quadrature", "quadrature", 0.01 * map.zeta});
    maps.push_back(map);
  }
  return maps;
}

std::optional<RepeatAgreement> compared(const std::vector<Profile>& maps, double label = 0.0) {
  std::vector<RepeatedMap> list;
  for (const Profile& map : maps) list.push_back({&map, Pressure::from_si(label)});
  return compare_repeats(list, Array1::Constant(maps.front().x.size(), kCompliance), kStretch);
}

TEST(Repeats, AreChiSquareOfTwoNumbersAMap) {
  for (const double label : {0.0, 10.0}) {
    RandomStream random(23, "repeats");
    constexpr int kTrials = 300;
    double sum = 0.0, scatter = 0.0;
    int n_below = 0;
    for (int trial = 0; trial < kTrials; ++trial) {
      const auto agreement = compared(seen(random, 3, label), label);
      ASSERT_TRUE(agreement);
      ASSERT_EQ(agreement->dof, 4.0);
      sum += agreement->chi_square / agreement->dof;
      scatter += agreement->scatter * agreement->scatter;
      n_below += numerics::chi_square_tail(agreement->chi_square, agreement->dof) < 0.05;
    }
    // 1200 degrees of freedom: 4 sigma of 4 %. 15 of 300: 4 sigma of 4.
    EXPECT_NEAR(sum / kTrials, 1.0, 0.17);
    EXPECT_NEAR(n_below, 15, 16);
    // Offset and label; pixels hardly matter in the mean of a hundred.
    const double expected = std::hypot(kOffset / kCompliance, label);
    EXPECT_NEAR(std::sqrt(scatter / kTrials) / expected, 1.0, 0.15);
  }
}

TEST(Repeats, TellAStateThatWasNotTheSame) {
  RandomStream random(24, "unlike");
  std::vector<Profile> maps = seen(random, 3);
  maps[1].zeta += 20.0 * kCompliance;
  const auto higher = compared(maps);
  // 20 Pa, and 1.3 Pa of the planes.
  EXPECT_NEAR(higher->scatter, 20.0 / std::sqrt(3.0), 2.0);
  EXPECT_LT(numerics::chi_square_tail(higher->chi_square, higher->dof), 1e-6);
  maps[1].zeta -= 20.0 * kCompliance;
  maps[1].zeta -= Array1::LinSpaced(maps[1].x.size(), -20.0, 20.0) * kCompliance;
  const auto steeper = compared(maps);
  EXPECT_LT(steeper->scatter, 5.0);
  EXPECT_LT(numerics::chi_square_tail(steeper->chi_square, steeper->dof), 1e-6);
}

TEST(Repeats, NeedTwoMapsStationsAndBars) {
  RandomStream random(25, "few");
  EXPECT_FALSE(compared(seen(random, 1)));
  std::vector<Profile> maps = seen(random, 2);
  EXPECT_TRUE(compared(maps));
  for (Profile& map : maps) {
    map.uncertainty.independent.setZero();
    map.uncertainty.modes.clear();
  }
  EXPECT_FALSE(compared(maps));
  maps = seen(random, 2);
  maps[1].flags.setOnes();
  EXPECT_FALSE(compared(maps));
}

}  // namespace
}  // namespace manoscope::inversion
