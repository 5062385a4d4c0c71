#include "manoscope/wall/square_wall.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "manoscope/core/error.hpp"
#include "manoscope/wall/foppl_von_karman.hpp"

namespace manoscope::wall {
namespace {

ClampedWall plate(Length thickness, double nu, Pressure prestress) {
  return {2.0 * mm, 2.0 * mm, thickness, 100.0 * GPa, nu, prestress};
}

WallState solved(const ClampedWall& wall, Pressure p, Index n_cells) {
  FopplVonKarmanOptions options;
  options.n_cells_x = 2 * n_cells;
  options.n_cells_z = n_cells;
  options.design_pressure = p;
  return FopplVonKarman(wall, options).equilibrium(WallLoad::uniform(p));
}

double mean_of(const auto& law) {
  double sum = 0.0;
  const int n = 4000;
  for (int i = 0; i < n; ++i) sum += law.shape(Length{}, (i + 0.5) / n) / n;
  return sum;
}

TEST(SquarePlate, IsTheFopplVonKarmanPlateUnderASmallLoad) {
  const ClampedWall wall = plate(10.0 * um, 0.3, {});
  const WallState state = solved(wall, 0.01 * Pa, 16);
  const SquarePlate law(wall.section());
  // 2e-6 of the thickness. Elements of 1/16 of the half side: fourth order, 1.7e-5 with half as
  // many and a sixteenth of it here.
  EXPECT_NEAR(state.deflection(1e-3, 0.0) / law.crest(0.01 * Pa).si(), 1.0, 1e-6);
  EXPECT_NEAR(state.average_deflection(1e-3) / law.deflection(0.01 * Pa).si(), 1.0, 2e-6);
  for (const double s : {0.2, 0.5, 0.8, 0.95}) {
    EXPECT_NEAR(state.deflection(1e-3, s * 1e-3) / state.deflection(1e-3, 0.0),
                law.shape(Length{}, s), 2e-6);
  }
  EXPECT_NEAR(mean_of(law), law.mean_over_crest(Length{}), 1e-6);  // the polynomial's 6e-7
}

TEST(SquarePlate, LeavesOutTheStretchingItStates) {
  const ClampedWall wall = plate(10.0 * um, 0.3, {});
  const SquarePlate law(wall.section());
  for (const double share : {0.1, 0.2}) {
    const Pressure p = law.pressure(share * 10.0 * um);
    const double off = 1.0 - solved(wall, p, 10).deflection(1e-3, 0.0) / (share * 10e-6);
    EXPECT_NEAR(off / (share * share), 0.52, 0.03) << share;
  }
}

TEST(SquareMembrane, IsThePoissonSolutionUnderTension) {
  const ClampedWall wall = plate(1.0 * um, 0.25, 200.0 * MPa);
  const SquareMembrane law(wall.section());
  EXPECT_NEAR(mean_of(law), law.mean_over_crest(Length{}), 1e-6);
  EXPECT_NEAR(law.shape(Length{}, 0.0), 1.0, 1e-10);
  // Double sine series of the tensioned square, an independent sum.
  double crest = 0.0;
  for (int m = 1; m < 801; m += 2) {
    for (int n = 1; n < 801; n += 2) {
      const double sign = ((m + n) / 2) % 2 == 1 ? 1.0 : -1.0;
      crest += sign / (double(m) * n * (double(m) * m + double(n) * n));
    }
  }
  const double pi = std::acos(-1.0);
  crest *= 16.0 / std::pow(pi, 4) * 4.0;  // side 2 a: (2 a)^2 p/(s0 t)
  const double small = 1e-6;
  const double expected = small * 1e-6 / (200e6 * 1e-6) * crest;
  // Alternating double series: the remainder is below the last row's 1e-7.
  EXPECT_NEAR(law.crest(Pressure::from_si(small)).si() / expected, 1.0, 1e-6);
}

TEST(SquareMembrane, IsTheThinLimitOfTheFopplVonKarmanWall) {
  for (const double nu : {0.0, 0.25, 0.5}) {
    const ClampedWall wall = plate(0.1 * um, nu, {});
    const WallState state = solved(wall, 20.0 * kPa, 12);
    const SquareMembrane law(wall.section());
    // Edge layer 3.3e-4 of the half side leaves 1e-3 of the pressure; constant to 1e-3.
    EXPECT_NEAR(law.pressure(Length::from_si(state.deflection(1e-3, 0.0))).si() / 20e3, 1.0, 2e-3);
    EXPECT_NEAR(state.average_deflection(1e-3) / state.deflection(1e-3, 0.0) / 0.6866175, 1.0,
                2.5e-3);
  }
}

TEST(SquareMembrane, SumOfPrestressAndStretchingIsWithinTheStatedError) {
  double worst = 0.0;
  for (const double prestress : {30.0, 100.0, 300.0}) {
    const ClampedWall wall = plate(0.1 * um, 0.25, prestress * MPa);
    const WallState state = solved(wall, 10.0 * kPa, 10);
    const SquareMembrane law(wall.section());
    worst = std::max(
        worst,
        std::abs(law.pressure(Length::from_si(state.deflection(1e-3, 0.0))).si() / 10e3 - 1.0));
  }
  EXPECT_LT(worst, 0.02);
  EXPECT_GT(worst, 0.001);
}

TEST(SquareMembrane, RefusesCompression) {
  EXPECT_THROW(SquareMembrane{plate(1.0 * um, 0.3, -1.0 * MPa).section()}, InputError);
}

}  // namespace
}  // namespace manoscope::wall
