#include "manoscope/wall/foppl_von_karman.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "manoscope/core/error.hpp"

namespace manoscope::wall {
namespace {

using std::numbers::pi;

FopplVonKarmanOptions cells(Index x, Index z) {
  FopplVonKarmanOptions options;
  options.n_cells_x = x;
  options.n_cells_z = z;
  return options;
}

const ClampedWall kSquare{2.0 * mm, 2.0 * mm, 10.0 * um, 100.0 * GPa, 0.3};

TEST(FopplVonKarman, LongPlateUnderASmallLoadIsTheClampedBeam) {
  // p w^4/(384 D) at the crest and p w^4/(720 D) on average. End effects decay as
  // exp(-2.106 x/a): 1e-8 at mid-length for l = 9.1 w. Stretching adds (zeta/t)^2, 1e-10 here.
  const ClampedWall plate{15.5 * mm, 1.7 * mm, 20.0 * um, 1.0 * GPa, 0.3};
  const FopplVonKarman wall(plate, cells(40, 8));
  const double p = 1e-3, w4 = std::pow(1.7e-3, 4), d = plate.bending_stiffness();
  const WallState state = wall.equilibrium(WallLoad::uniform(Pressure::from_si(p)));
  ASSERT_LT(state.deflection(7.75e-3, 0.0) / 20e-6, 1e-4);
  EXPECT_NEAR(state.deflection(7.75e-3, 0.0) / (p * w4 / (384.0 * d)), 1.0, 1e-6);
  // The crest is a node, where cubic elements meet the quartic exactly; the average between nodes
  // is wrong by the fourth power of the cell size, 1/8 to the fourth over 10 to begin with.
  const auto error = [&](Index n) {
    return FopplVonKarman(plate, cells(40, n))
                   .equilibrium(WallLoad::uniform(Pressure::from_si(p)))
                   .average_deflection(7.75e-3) /
               (p * w4 / (720.0 * d)) -
           1.0;
  };
  const double at_4 = error(4), at_8 = error(8), at_16 = error(16);
  EXPECT_LT(std::abs(at_8), 1e-4);
  EXPECT_NEAR(std::log2(at_4 / at_8), 4.0, 0.3);
  EXPECT_NEAR(std::log2(at_8 / at_16), 4.0, 0.2);
}

TEST(FopplVonKarman, SquarePlateConvergesWithTheFourthPowerOfTheCellSize) {
  // Centre of a clamped square under a small load: 0.00126532 p w^4/D (series of Timoshenko &
  // Woinowsky-Krieger, art. 44, to the digits of later computations).
  const double p = 1e-3, unit = p * std::pow(2e-3, 4) / kSquare.bending_stiffness();
  std::vector<double> centre;
  for (const Index n : {4, 8, 16, 32}) {
    const FopplVonKarman wall(kSquare, cells(n, n / 2));
    centre.push_back(
        wall.equilibrium(WallLoad::uniform(Pressure::from_si(p))).deflection(1e-3, 0.0) / unit);
  }
  EXPECT_NEAR(centre.back(), 0.00126532, 5e-9);
  // Differences of successive grids fall by 16; graded cells of few are not yet quite there.
  const double order = std::log2(std::abs((centre[2] - centre[1]) / (centre[3] - centre[2])));
  EXPECT_GT(order, 3.5);
  EXPECT_LT(order, 5.0);
}

TEST(FopplVonKarman, BucklingStressOfASquareIsTheKnownOne) {
  // k = 5.3036 (Timoshenko & Gere; five digits): 1e-4 relative.
  const double unit = pi * pi * kSquare.bending_stiffness() / (4e-6 * 10e-6);
  const FopplVonKarman wall(kSquare, cells(24, 12));
  EXPECT_NEAR(-wall.critical_prestress().si() / unit / 5.3036, 1.0, 1e-4);
}

/// Buckling stress of an infinitely long clamped strip under equal compression both ways, for waves
/// cos(k x), in pi^2 D/(w^2 t): f = A cosh(k z) + B cos(m z), m^2 = N/D - k^2, clamped at z = +-a,
/// k tanh(k a) + m tan(m a) = 0 with m a in (pi/2, pi]. Lengths in a.
double strip_factor(double k) {
  double low = pi / 2.0 + 1e-12, high = pi;
  for (int n = 0; n < 200; ++n) {
    const double m = 0.5 * (low + high);
    (k * std::tanh(k) + m * std::tan(m) < 0.0 ? low : high) = m;
  }
  return 4.0 * (low * low + k * k) / (pi * pi);
}

TEST(FopplVonKarman, LongStripBucklesInWavesBelowTheStressOfTheCylindricalMode) {
  EXPECT_NEAR(strip_factor(1e-9), 4.0, 1e-12);  // 4 pi^2 D/(w^2 t): no waves along x
  double k_least = 0.0;
  for (double k = 0.0; k < 3.0; k += 1e-3) {
    if (strip_factor(k) < strip_factor(k_least)) k_least = k;
  }
  const double infinite = strip_factor(k_least);
  EXPECT_LT(infinite, 4.0);
  const ClampedWall strip{16.0 * mm, 2.0 * mm, 10.0 * um, 100.0 * GPa, 0.3};
  const double unit = pi * pi * strip.bending_stiffness() / (4e-6 * 10e-6);
  const double found = -FopplVonKarman(strip, cells(48, 8)).critical_prestress().si() / unit;
  // A finite length modulates the waves over l: the factor rises by half the curvature of
  // strip_factor times (pi/l)^2; never below the infinite strip. l = 16 a.
  const double h = 1e-2;
  const double curvature =
      (strip_factor(k_least + h) - 2.0 * infinite + strip_factor(k_least - h)) / (h * h);
  const double correction = 0.5 * curvature * std::pow(pi / 16.0, 2);
  EXPECT_GT(found, infinite * (1.0 - 1e-5));
  EXPECT_LT(found, infinite + 1.3 * correction);
}

TEST(FopplVonKarman, ThickElastomerAddsTheShearOfTimoshenkosStrip) {
  // p w^4/(384 D) + p w^2/(8 kappa G t): exact for a strip. The end effect of the shear part
  // decays as exp(-pi x/(2 a)): (4/pi) e^(-14.3) = 8e-7 at mid-length.
  const double e = 1e6, nu = 0.49, t = 605e-6, kappa = 5.0 / 6.0, width = 1.7e-3, p = 0.01;
  ClampedWall plate{15.5 * mm, 1.7 * mm, 605.0 * um, 1.0 * MPa, nu};
  plate.shear_correction = kappa;
  const double bending = p * std::pow(width, 4) / (384.0 * plate.bending_stiffness());
  const double shear = p * width * width / (8.0 * kappa * e / (2.0 * (1.0 + nu)) * t);
  EXPECT_NEAR(shear / bending, 8.0 * t * t / (kappa * (1.0 - nu) * width * width), 1e-9);  // 2.4
  const auto crest = [&](const ClampedWall& wall) {
    return FopplVonKarman(wall, cells(40, 8))
        .equilibrium(WallLoad::uniform(Pressure::from_si(p)))
        .deflection(7.75e-3, 0.0);
  };
  EXPECT_NEAR(crest(plate) / (bending + shear), 1.0, 2e-6);
  plate.shear_correction = 0.0;
  EXPECT_NEAR(crest(plate) / bending, 1.0, 1e-6);
  // A thin wall does not notice its shear flexibility: 8 t^2/(kappa (1 - nu) w^2) = 2.6e-6.
  plate.thickness = 1.0 * um;
  const double rigid = FopplVonKarman(plate, cells(40, 8))
                           .equilibrium(WallLoad::uniform(Pressure::from_si(1e-12)))
                           .deflection(7.75e-3, 0.0);
  plate.shear_correction = kappa;
  const double flexible = FopplVonKarman(plate, cells(40, 8))
                              .equilibrium(WallLoad::uniform(Pressure::from_si(1e-12)))
                              .deflection(7.75e-3, 0.0);
  EXPECT_NEAR(flexible / rigid - 1.0, 8e-12 / (kappa * (1.0 - nu) * width * width), 2e-7);
}

TEST(FopplVonKarman, HalfAndWholeModelAgreeAndALopsidedLoadNeedsTheWhole) {
  FopplVonKarmanOptions half = cells(8, 4), whole = half;
  whole.symmetric = false;
  const FopplVonKarman a(kSquare, half), b(kSquare, whole);
  const WallLoad even = WallLoad::field(
      [](double x, double z) { return 3e4 * (1.0 + 300.0 * x) * (1.0 - 4e5 * z * z); });
  const WallState from_half = a.equilibrium(even), from_whole = b.equilibrium(even);
  for (const double z : {0.0, 0.3e-3, -0.7e-3}) {
    EXPECT_NEAR(from_whole.deflection(0.8e-3, z) / from_half.deflection(0.8e-3, z), 1.0, 1e-7);
  }
  EXPECT_NEAR(from_whole.volume() / from_half.volume(), 1.0, 1e-7);
  EXPECT_NEAR(from_whole.elastic_energy() / from_half.elastic_energy(), 1.0, 1e-7);
  const WallLoad leaning =
      WallLoad::field([](double, double z) { return 3e4 * (1.0 + 500.0 * z); });
  EXPECT_THROW(a.equilibrium(leaning), InputError);
  const WallState leant = b.equilibrium(leaning);
  EXPECT_GT(leant.deflection(1e-3, 0.5e-3), 1.05 * leant.deflection(1e-3, -0.5e-3));
}

TEST(FopplVonKarman, APressureOddAcrossBendsALongWallAsItDoesAClampedStrip) {
  // p = p0 s, s = z/a, on the strip W'''' - q W'' = s, W = W' = 0 at the edges; zeta = p0 a^4/D W.
  //   q = 0:  W = s (1 - s^2)^2/120,
  //   q > 0:  W = (A s - s^3/6 + B sinh(u s))/q, u^2 = q, from the particular solution -s^3/(6 q).
  ClampedWall plate{10.2 * mm, 1.7 * mm, 20.0 * um, 1.0 * GPa, 0.3};
  FopplVonKarmanOptions whole = cells(20, 8);
  whole.symmetric = false;
  const double a = 0.85e-3, p0 = 1e-3, stiffness = plate.bending_stiffness();
  for (const double q : {0.0, 25.0}) {
    plate.prestress = Pressure::from_si(q * stiffness / (a * a * plate.thickness.si()));
    const FopplVonKarman wall(plate, whole);
    const WallState state =
        wall.equilibrium(WallLoad::field([&](double, double z) { return p0 * z / a; }));
    const auto strip = [&](double s) {
      if (q == 0.0) return s * std::pow(1.0 - s * s, 2) / 120.0;
      const double u = std::sqrt(q), b = 1.0 / 3.0 / (u * std::cosh(u) - std::sinh(u));
      return (s * (1.0 / 6.0 - b * std::sinh(u)) - s * s * s / 6.0 + b * std::sinh(u * s)) / q;
    };
    for (const double s : {-0.75, -0.5, 0.25, 0.5, 0.75}) {
      // Ends decay within a width, their traces at mid-length by exp(-2.1 6), 3e-6; eight cells
      // over the half width, fourth order: (1/8)^4, 2.4e-4.
      EXPECT_NEAR(state.deflection(5.1e-3, s * a) / (p0 * std::pow(a, 4) / stiffness) / strip(s),
                  1.0, 3e-4)
          << q << " " << s;
    }
    EXPECT_NEAR(state.average_deflection(5.1e-3) / state.deflection(5.1e-3, 0.45 * a), 0.0, 1e-9);
  }
}

TEST(FopplVonKarman, LoadsGivenThreeWaysAgree) {
  const FopplVonKarman wall(kSquare, cells(8, 4));
  Array1 x(2), p(2);
  x << 0.0, 2e-3;
  p << 1e4, 5e4;
  const double along = wall.equilibrium(WallLoad::along(x, p)).deflection(1.2e-3, 0.0);
  const double field =
      wall.equilibrium(WallLoad::field([](double at, double) { return 1e4 + 2e7 * at; }))
          .deflection(1.2e-3, 0.0);
  EXPECT_NEAR(field / along, 1.0, 1e-9);
  // A preload acts like that much pressure from the other side.
  ClampedWall held = kSquare;
  held.preload = {3e4 * Pa, 4.0 / 3.0};  // 1e4 Pa at x = 0, 5e4 Pa at x = l
  const WallState down = FopplVonKarman(held, cells(8, 4)).equilibrium(WallLoad::uniform({}));
  EXPECT_NEAR(down.deflection(1.2e-3, 0.0) / along, -1.0, 1e-8);
}

TEST(FopplVonKarman, RestsAtItsInitialShapeWhenNothingActsOnIt) {
  ClampedWall shaped = kSquare;
  shaped.initial_shape = {-5.0 * um, 0.5};
  const FopplVonKarman wall(shaped, cells(8, 4));
  const WallState rest = wall.equilibrium(WallLoad::uniform({}));
  EXPECT_NEAR(rest.deflection(1.3e-3, 0.2e-3) / wall.unloaded().deflection(1.3e-3, 0.2e-3), 1.0,
              1e-7);
  EXPECT_LT(rest.deflection(1e-3, 0.0), -0.2e-6);
  EXPECT_LT(rest.deflection(1.4e-3, 0.0), rest.deflection(0.6e-3, 0.0));
  EXPECT_EQ(rest.deflection(-1e-6, 0.0), 0.0);
  EXPECT_EQ(rest.average_deflection(2.1e-3), 0.0);
}

TEST(FopplVonKarman, RefusesPropertiesAndLoadsOutOfRange) {
  const auto refused = [](auto change) {
    ClampedWall wall = kSquare;
    change(wall);
    EXPECT_THROW(FopplVonKarman(wall, cells(4, 2)), InputError);
  };
  refused([](ClampedWall& w) { w.thickness = -1.0 * um; });
  refused([](ClampedWall& w) { w.length = Length{}; });
  refused([](ClampedWall& w) { w.width = -1.0 * mm; });
  refused([](ClampedWall& w) { w.youngs_modulus = Pressure{}; });
  refused([](ClampedWall& w) { w.poisson_ratio = 0.6; });
  refused([](ClampedWall& w) { w.shear_correction = 1.5; });
  refused([](ClampedWall& w) { w.prestress = std::numeric_limits<double>::infinity() * Pa; });
  EXPECT_THROW(FopplVonKarman(kSquare, cells(5, 2)), InputError);
  EXPECT_THROW(FopplVonKarman(kSquare, cells(4, 200)), InputError);
  Array1 two(2), down(2);
  two << 0.0, 1.0;
  down << 1.0, 0.0;
  EXPECT_THROW(WallLoad::along(two, Array1::Zero(3)), InputError);
  EXPECT_THROW(WallLoad::along(down, two), InputError);
  const FopplVonKarman wall(kSquare, cells(4, 2));
  EXPECT_THROW(wall.influence(wall.unloaded(), down), InputError);
}

TEST(FopplVonKarman, SaysSoWhenNoEquilibriumIsFoundInTheStepsAllowed) {
  FopplVonKarmanOptions hurried = cells(4, 2);
  hurried.max_iterations = 1;
  const FopplVonKarman wall(kSquare, hurried);
  EXPECT_THROW(wall.equilibrium(WallLoad::uniform(1.0 * MPa)), InputError);
}

}  // namespace
}  // namespace manoscope::wall
