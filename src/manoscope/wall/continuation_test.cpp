#include "manoscope/wall/continuation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "manoscope/core/error.hpp"

namespace manoscope::wall {
namespace {

FopplVonKarmanOptions coarse() {
  FopplVonKarmanOptions options;
  options.n_cells_x = 12;
  options.n_cells_z = 4;
  options.design_pressure = 1.0 * kPa;
  return options;
}

/// A wall compressed to `times` its buckling stress, with a slight downward shape.
ClampedWall buckled(double times) {
  ClampedWall wall{3.0 * mm, 1.7 * mm, 1.0 * um, 250.0 * GPa, 0.23};
  wall.prestress = times * FopplVonKarman(wall, coarse()).critical_prestress();
  wall.initial_shape = {-0.05 * um, 0.1};
  return wall;
}

WallLoad load(double p) { return WallLoad::uniform(Pressure::from_si(p)); }

TEST(FollowPressure, OfATautWallIsOneBranchOfTheSameStatesAsDirectSolutions) {
  ClampedWall taut{3.0 * mm, 1.7 * mm, 1.0 * um, 250.0 * GPa, 0.23, 20.0 * MPa};
  const FopplVonKarman wall(taut, coarse());
  const Array1 p = Array1::LinSpaced(4, 0.0, 3e3);
  const LoadPath path = follow_pressure(wall, wall.unloaded(), p);
  EXPECT_TRUE(path.snaps.empty());
  ASSERT_EQ(path.states.size(), 4u);
  for (Index i = 1; i < 4; ++i) {
    // Two iterations to a residual of 1e-9 of the same equations.
    EXPECT_NEAR(path.states[i].volume() / wall.equilibrium(load(p(i))).volume(), 1.0, 1e-7);
  }
}

TEST(FollowLoad, TakesAChangeOfRoundOffInOneStep) {
  const ClampedWall soft{10.0 * mm, 1.0 * mm, 100.0 * um, 1.0 * MPa, 0.49};
  int n_factorisations = 0;
  Monitor count;
  count.stop_requested = [&] {
    ++n_factorisations;
    return false;
  };
  const FopplVonKarman wall(soft, coarse(), count);
  Array1 x(3), p(3);
  x << 0.0, 5e-3, 10e-3;
  p << 1639.29, 900.0, 0.0;
  const WallState start = wall.equilibrium(WallLoad::along(x, p));
  n_factorisations = 0;
  const auto from = WallLoad::along(x, p), to = WallLoad::along(x, p * (1.0 + 4e-16));
  const FollowedLoad followed = follow_load(wall, start, from, to);
  // The work of such a change is noise: it must not be halved down to the resolution a thousand
  // times over.
  EXPECT_LT(n_factorisations, 5);
  EXPECT_TRUE(followed.ends.empty());
  EXPECT_NEAR(followed.state.volume() / start.volume(), 1.0, 1e-9);
}

TEST(FollowLoad, IsInterruptedWithinASolution) {
  int left = 7;
  Monitor stop;
  stop.stop_requested = [&] { return left-- <= 0; };
  const FopplVonKarman wall(buckled(3.0), coarse(), stop);
  EXPECT_THROW(follow_pressure(wall, wall.unloaded(), Array1::LinSpaced(20, 0.0, 3e3)),
               Interrupted);
  EXPECT_EQ(left, -1);  // nothing was solved after
}

TEST(FollowPressure, OfABuckledWallSnapsThroughUpwardAndBackAtAnotherPressure) {
  const FopplVonKarman wall(buckled(3.0), coarse());
  const WallState down = wall.equilibrium(load(0.0));
  EXPECT_LT(down.average_deflection(1.5e-3), 0.0);
  EXPECT_EQ(down.n_unstable(), 0);
  const Array1 up_path = Array1::LinSpaced(9, 0.0, 160.0);
  const LoadPath up = follow_pressure(wall, down, up_path);
  ASSERT_EQ(up.snaps.size(), 1u);
  const SnapThrough& snap = up.snaps.front();
  EXPECT_GT(snap.pressure.si(), 0.0);
  EXPECT_LE(snap.uncertainty.si(), 0.02);  // 1e-3 of the step of 20 Pa
  EXPECT_LT(snap.before.volume(), 0.0);
  EXPECT_GT(snap.after.volume(), 0.0);
  for (const WallState& state : up.states) EXPECT_EQ(state.n_unstable(), 0);

  // On the way back the upper branch holds past the pressure at which the lower one ended:
  // at p = 0 two states stand, one above and one below the plane.
  const LoadPath back = follow_pressure(wall, up.states.back(), Array1(-up_path + 160.0));
  EXPECT_TRUE(back.snaps.empty());
  EXPECT_GT(back.states.back().volume(), 0.0);
  EXPECT_EQ(back.states.back().n_unstable(), 0);
  const LoadPath on = follow_pressure(wall, back.states.back(), Array1(-up_path));
  ASSERT_EQ(on.snaps.size(), 1u);
  EXPECT_LT(on.states.back().volume(), 0.0);
  // Slightly shaped downward, the wall leaves the upper branch more readily than the lower.
  EXPECT_LT(std::abs(on.snaps.front().pressure.si()), snap.pressure.si());
}

TEST(FollowPressure, EndsTheBranchOfASlightlyBuckledSquareWhereKoitersCubicEnds) {
  // Just beyond its buckling load a flat wall follows its first mode alone, A^3 - A0^2 A = const p
  // (Koiter 1945): the branch bowed against p ends at p = 2/(3 sqrt 3) A0/c, with A0 the crest at
  // rest and c the compliance of the flat wall as far below the buckling load as this one is above
  // it. Both are found without following anything; the cubic is exact as that distance vanishes.
  ClampedWall flat{1.7 * mm, 1.7 * mm, 1.0 * um, 250.0 * GPa, 0.23};
  const Pressure critical = FopplVonKarman(flat, coarse()).critical_prestress();
  double before = 1.0;
  for (const double beyond : {0.08, 0.04, 0.02}) {
    flat.prestress = (1.0 - beyond) * critical;
    const FopplVonKarman below(flat, coarse());
    const double little = 1e-4;  // Pa: stretching takes 1e-6 of the deflection
    const double compliance = below.equilibrium(load(little)).deflection(0.85e-3, 0.0) / little;
    flat.prestress = (1.0 + beyond) * critical;
    const FopplVonKarman wall(flat, coarse());
    // Pushed down and let go.
    const WallState down = wall.equilibrium(load(0.0), wall.equilibrium(load(-10.0)));
    const double rest = -down.deflection(0.85e-3, 0.0);
    ASSERT_GT(rest, 0.0);
    const double koiter = 2.0 / (3.0 * std::sqrt(3.0)) * rest / compliance;
    const LoadPath up = follow_pressure(wall, down, Array1::LinSpaced(5, 0.0, 2.0 * koiter));
    ASSERT_EQ(up.snaps.size(), 1u) << beyond;
    EXPECT_LT(up.snaps[0].before.volume(), 0.0);
    EXPECT_GT(up.snaps[0].after.volume(), 0.0);
    const double off = std::abs(up.snaps[0].pressure.si() / koiter - 1.0);
    // First order in the distance, with a tenth before it (0.7, 0.4 and 0.2 %); a branch end is
    // found to 1e-3 of steps of half of the pressure.
    EXPECT_LT(off, 0.1 * beyond + 5e-4) << beyond;
    EXPECT_LT(off, 0.6 * before + 5e-4) << beyond;
    before = off;
  }
}

TEST(FollowPressure, EnergyGrowsByThePressureTimesTheVolumeAlongABranch) {
  // dU = p dV: a central difference over +-h has an error of (h/p)^2 times a number of order one.
  const FopplVonKarman wall(buckled(2.0), coarse());
  const double p = 400.0, h = 2.0;
  const WallState state = wall.equilibrium(load(p));
  const WallState above = wall.equilibrium(load(p + h), state);
  const WallState below = wall.equilibrium(load(p - h), state);
  EXPECT_NEAR(
      (above.elastic_energy() - below.elastic_energy()) / (above.volume() - below.volume()) / p,
      1.0, 1e-4);
}

TEST(FollowPressure, RefusesPathsWithoutFinitePressures) {
  ClampedWall taut{3.0 * mm, 1.7 * mm, 1.0 * um, 250.0 * GPa, 0.23, 20.0 * MPa};
  const FopplVonKarman wall(taut, coarse());
  EXPECT_THROW(follow_pressure(wall, wall.unloaded(), Array1()), InputError);
  EXPECT_THROW(follow_pressure(wall, wall.unloaded(),
                               Array1::Constant(1, std::numeric_limits<double>::infinity())),
               InputError);
  EXPECT_THROW(follow_pressure(wall, wall.unloaded(), Array1::Zero(1), {0.0}), InputError);
}

}  // namespace
}  // namespace manoscope::wall
