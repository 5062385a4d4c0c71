// Large deflections, tension and influence of the Foeppl-von Karman wall.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "manoscope/wall/bulge.hpp"
#include "manoscope/wall/foppl_von_karman.hpp"

namespace manoscope::wall {
namespace {

using std::numbers::pi;

ClampedWall nitride(double prestress_mpa) {
  return {15.5 * mm, 1.7 * mm, 0.2 * um, 250.0 * GPa, 0.23, prestress_mpa * MPa};
}

FopplVonKarmanOptions cells(Index x, Index z, Pressure design = 10.0 * kPa) {
  FopplVonKarmanOptions options;
  options.n_cells_x = x;
  options.n_cells_z = z;
  options.design_pressure = design;
  return options;
}

/// Cylindrical bending of an infinitely long clamped strip, exact: under a tension N
///   w' = -(p/N) (z - a sinh(z/d)/sinh(a/d)),  d = sqrt(D/N),
///   crest = (p/N) (a^2/2 - a d tanh(a/(2 d))),  N = s0 t + E t/(1 - nu^2) (1/2a) int w'^2 dz,
/// the last over half the width. Source: Timoshenko & Woinowsky-Krieger, ch. 1.
double exact_strip_crest(const ClampedWall& wall, double p) {
  const double a = 0.5 * wall.width.si(), t = wall.thickness.si(), d3 = wall.bending_stiffness();
  const double stretch = 12.0 * d3 / (t * t);
  const auto excess = [&](double n) {
    const double d = std::sqrt(d3 / n), sharp = a / d;  // sharp is large: sinh ratios by limits
    const double coth = 1.0 / std::tanh(sharp);
    // int_0^a (z - a sinh(z/d)/sinh(a/d))^2 dz
    const double csch2 = 1.0 / std::pow(std::sinh(std::min(sharp, 300.0)), 2);
    const double integral =
        a * a * a / 3.0 - 2.0 * a * (a * d * coth - d * d) + a * a * 0.5 * (d * coth - a * csch2);
    return wall.prestress.si() * t + stretch / (2.0 * a) * (p / n) * (p / n) * integral - n;
  };
  double low = 1e-6, high = 1e6;
  for (int k = 0; k < 300; ++k) {
    const double middle = std::sqrt(low * high);
    (excess(middle) > 0.0 ? low : high) = middle;
  }
  const double d = std::sqrt(d3 / low);
  return p / low * (0.5 * a * a - a * d * std::tanh(0.5 * a / d));
}

TEST(FopplVonKarman, MidChannelIsTheExactStripAndTheBulgeLawButForTheEdgeLayer) {
  for (const double p : {1e3, 50e3}) {
    const ClampedWall wall = nitride(100.0);
    const WallState state = FopplVonKarman(wall, cells(40, 14, Pressure::from_si(p)))
                                .equilibrium(WallLoad::uniform(Pressure::from_si(p)));
    EXPECT_LE(state.residual(), 1e-8);
    const double crest = state.deflection(7.75e-3, 0.0);
    // Discretisation of the edge layer: 1e-5 at this grid, a sixteenth of it at twice the cells.
    EXPECT_NEAR(crest / exact_strip_crest(wall, p), 1.0, 1e-5) << p;
    // The classical law leaves bending out. The clamped layer d = sqrt(D/N) takes 2 d/a off the
    // crest at given N and 4.5 d/a off the stretching: the law's pressure for this crest is low by
    // 2 d/a where prestress carries the load and 1.5 d/a where stretching does.
    const LongMembrane law(
        {wall.width, wall.thickness, wall.youngs_modulus, wall.poisson_ratio, wall.prestress});
    const double deviation = 1.0 - law.pressure(Length::from_si(crest)).si() / p;
    const double layer = wall.edge_layer(Pressure::from_si(p)) / 0.85e-3;
    EXPECT_LT(deviation, p > 40e3 ? 0.005 : 0.01);
    EXPECT_GT(deviation, 1.45 * layer) << p;
    EXPECT_LT(deviation, 2.05 * layer) << p;
  }
}

TEST(FopplVonKarman, DeviationFromTheBulgeLawFallsWithTheEdgeLayer) {
  // Without prestress d ~ p^(-1/3): eight times the pressure halves it.
  const ClampedWall wall = nitride(0.0);
  const LongMembrane law({wall.width, wall.thickness, wall.youngs_modulus, wall.poisson_ratio, {}});
  const auto deviation = [&](double p) {
    return 1.0 - law.pressure(Length::from_si(exact_strip_crest(wall, p))).si() / p;
  };
  EXPECT_NEAR(deviation(48e3) / deviation(6e3), 0.5, 0.005);
  EXPECT_NEAR(deviation(48e3) / (wall.edge_layer(48.0 * kPa) / 0.85e-3), 1.5, 0.015);
}

TEST(FopplVonKarman, SlackNitrideIsSolvedFromTheFlatWallUnderItsHighestPressure) {
  // No prestress, 360 thicknesses of deflection. The grid's error as above, twice for a layer
  // without prestress to widen it.
  const ClampedWall wall = nitride(0.0);
  const WallState state =
      FopplVonKarman(wall, cells(40, 14, 50.0 * kPa)).equilibrium(WallLoad::uniform(50.0 * kPa));
  EXPECT_LE(state.residual(), 1e-8);
  EXPECT_EQ(state.n_unstable(), 0);
  EXPECT_NEAR(state.deflection(7.75e-3, 0.0) / exact_strip_crest(wall, 50e3), 1.0, 2e-5);
}

TEST(FopplVonKarman, InfluenceIsTheDerivativeOfTheDeflection) {
  const FopplVonKarman wall(nitride(100.0), cells(24, 6));
  const Array1 x = Array1::LinSpaced(9, 1e-3, 14.5e-3);
  const Array1 p = Array1::LinSpaced(9, 8e3, 2e3);
  const WallState state = wall.equilibrium(WallLoad::along(x, p));
  const Matrix influence = wall.influence(state, x);
  for (const Index j : {0, 4}) {
    Array1 up = p, down = p;
    const double h = 1.0;  // second order: (h/p)^2 ~ 1e-7 relative
    up(j) += h;
    down(j) -= h;
    const Array1 slope = (wall.equilibrium(WallLoad::along(x, up), state).average_deflection(x) -
                          wall.equilibrium(WallLoad::along(x, down), state).average_deflection(x)) /
                         (2.0 * h);
    EXPECT_LT((slope.matrix() - influence.col(j)).norm() / influence.col(j).norm(), 1e-6);
  }
  // Row sums: a uniform change.
  const Array1 raised = wall.equilibrium(WallLoad::along(x, p + 1.0), state).average_deflection(x) -
                        wall.equilibrium(WallLoad::along(x, p - 1.0), state).average_deflection(x);
  EXPECT_LT((influence.rowwise().sum().array() - 0.5 * raised).matrix().norm(),
            1e-6 * raised.matrix().norm());
}

TEST(FopplVonKarman, InfluenceOfATensionedWallFallsOffOverWidthOverPi) {
  // Far from the load the slowest mode cos(pi z/w) exp(-pi x/w) is left: next one exp(-3 pi x/w).
  ClampedWall wall = nitride(300.0);
  wall.length = 10.0 * mm;
  const FopplVonKarman model(wall, cells(64, 8, 10.0 * Pa));
  const WallState state = model.equilibrium(WallLoad::uniform(10.0 * Pa));
  const Array1 x = Array1::LinSpaced(101, 0.0, 10e-3);
  const Matrix influence = model.influence(state, x);
  const double length = 1e-3 / std::log(influence(60, 50) / influence(70, 50));
  EXPECT_NEAR(length / (1.7e-3 / pi), 1.0, 0.03);
}

TEST(FopplVonKarman, SameInputGivesTheSameBytes) {
  const auto solve = [] {
    return FopplVonKarman(nitride(100.0), cells(12, 4)).equilibrium(WallLoad::uniform(2.0 * kPa));
  };
  EXPECT_TRUE(solve().unknowns() == solve().unknowns());
}

}  // namespace
}  // namespace manoscope::wall
