#include "manoscope/wall/buckled_strip.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "manoscope/core/arrays.hpp"
#include "manoscope/core/error.hpp"
#include "manoscope/wall/plate_strip.hpp"
#include "manoscope/wall/strip_bending.hpp"

namespace manoscope::wall {
namespace {

/// Wall of sample S1 under a compression.
WallSection nitride(Pressure compression) {
  return {1.7 * mm, 0.2 * um, 250.0 * GPa, 0.23, -compression};
}

/// The same wall, compressed by so many times what buckles it.
WallSection buckled(double times) {
  return nitride(-times * PlateStrip::buckling_prestress(nitride(Pressure{})));
}

/// Pressure for P = 1.
double scale(const WallSection& s) {
  return s.bending_stiffness() * s.thickness.si() / std::pow(s.half_width(), 4);
}

/// The strip by finite differences on n interior nodes of [-1, 1], deflections in thicknesses:
/// bending B, slope K, both per node.
struct Differences {
  Matrix bending, slope;
  double step;

  explicit Differences(Index n)
      : bending(Matrix::Zero(n, n)),
        slope(Matrix::Zero(n, n)),
        step(2.0 / static_cast<double>(n + 1)) {
    for (Index i = 0; i < n; ++i) {
      slope(i, i) = 2.0;
      if (i > 0) slope(i, i - 1) = slope(i - 1, i) = -1.0;
    }
    bending = slope * slope;
    // Clamped: a mirrored node beyond each edge.
    bending(0, 0) = bending(n - 1, n - 1) = 7.0;
    slope /= step * step;
    bending /= step * step * step * step;
  }
};

/// Strip with the tension q, and the pressure P under which it stands bowed against it.
struct State {
  double load;
  Index n_even, n_odd;  ///< directions of either parity in which the energy falls
};

State state_of(const Differences& strip, double q, double rest) {
  const Index n = strip.slope.rows();
  const Matrix linear = strip.bending + q * strip.slope;
  const Eigen::VectorXd unit = linear.partialPivLu().solve(Eigen::VectorXd::Ones(n));
  // Average of W'^2/2 over the width.
  const double stretch = 0.25 * strip.step * unit.dot(strip.slope * unit);
  State made{};
  made.load = std::sqrt((q - rest) / (12.0 * stretch));
  const Eigen::VectorXd pull = made.load * (strip.slope * unit);
  const Matrix hessian = linear + 6.0 * strip.step * pull * pull.transpose();
  const Eigen::SelfAdjointEigenSolver<Matrix> modes(hessian);
  for (Index k = 0; k < n && modes.eigenvalues()(k) < 0.0; ++k) {
    const auto mode = modes.eigenvectors().col(k);
    const bool even = mode.dot(mode.reverse()) > 0.0;
    ++(even ? made.n_even : made.n_odd);
  }
  return made;
}

TEST(StripSnap, IsWhereTheStripByFiniteDifferencesLosesItsFooting) {
  const Differences strip(99);
  const double pi2 = std::numbers::pi * std::numbers::pi;
  for (const double times : {1.5, 9.0, 90.0}) {
    const double rest = -times * pi2;
    const StripSnap snap = strip_snap(buckled(times));
    double largest = 0.0, odd_at = 0.0;
    Index n_even = 0, n_odd = 0;
    const double lowest = std::max(rest, -4.0 * pi2);
    for (int k = 1; k < 90; ++k) {
      const double q = -pi2 + k / 90.0 * (lowest + pi2);
      const State now = state_of(strip, q, rest);
      // The even state loses its footing where its load is largest, and nowhere else.
      if (now.load > 1.001 * largest) {
        EXPECT_EQ(now.n_even, 0) << q;
      } else if (now.load < 0.999 * largest) {
        EXPECT_EQ(now.n_even, 1) << q;
      }
      if (now.n_odd > 0 && n_odd == 0) odd_at = now.load;
      n_odd = std::max(n_odd, now.n_odd);
      n_even = std::max(n_even, now.n_even);
      largest = std::max(largest, now.load);
    }
    EXPECT_EQ(n_even, 1) << times;
    // Steps h = 1/50: second order, (u h)^2/12 of h, u up to 5.3; a maximum between two points.
    EXPECT_NEAR(snap.limit.si() / scale(buckled(times)) / largest, 1.0, 3e-3) << times;
    ASSERT_EQ(snap.bifurcation.has_value(), times > 2.0) << times;
    if (snap.bifurcation) {
      EXPECT_EQ(n_odd, 1) << times;
      // Seen at the next of 90 points.
      EXPECT_NEAR(snap.bifurcation->si() / scale(buckled(times)) / odd_at, 1.0, 0.02) << times;
      EXPECT_LT(*snap.bifurcation, snap.limit);
      EXPECT_EQ(snap.bears(), *snap.bifurcation);
    } else {
      EXPECT_EQ(snap.bears(), snap.limit);
    }
  }
}

TEST(StripSnap, OfASlightlyBuckledStripIsKoitersCubic) {
  // Near its buckling load the strip follows its mode alone, A^3 - A0^2 A = const p: the lower
  // branch ends at p = 2/(3 sqrt 3) A0/c, c the compliance as far below the buckling load as the
  // strip is above it. What is left is of the order of that distance.
  double before = 1.0;
  for (const double beyond : {0.08, 0.04, 0.02, 0.01}) {
    const double pi2 = std::numbers::pi * std::numbers::pi;
    // A0 (1 + cos pi s)/2 stretches by pi^2 A0^2/16: 12 times that is the tension to make up.
    const double rest = std::sqrt(4.0 / 3.0 * beyond);
    const double koiter =
        2.0 / (3.0 * std::sqrt(3.0)) * rest / StripBending::at(-(1.0 - beyond) * pi2).f;
    const WallSection wall = buckled(1.0 + beyond);
    const double off = std::abs(strip_snap(wall).limit.si() / scale(wall) / koiter - 1.0);
    EXPECT_LT(off, beyond) << beyond;
    EXPECT_LT(off, 0.6 * before) << beyond;  // first order
    before = off;
  }
}

TEST(StripSnap, OfTheNitrideWallIsHundredthsOfAPascalAndGrowsAsTheRootOfItsCompression) {
  // What the page on virtual experiments says of the wall of S1; to the digits printed there.
  const StripSnap slack = strip_snap(nitride(1.0 * MPa)), tight = strip_snap(nitride(10.0 * MPa));
  EXPECT_NEAR(slack.limit.si(), 0.024, 5e-4);
  EXPECT_NEAR(slack.bears().si(), 0.017, 5e-4);
  EXPECT_NEAR(tight.limit.si(), 0.078, 5e-4);
  EXPECT_NEAR(tight.bears().si(), 0.055, 5e-4);
  EXPECT_NEAR(strip_snap(nitride(0.1 * MPa)).bears().si(), 0.0048, 5e-5);
  // P = sqrt((n - n0)/(12 h)) with n of 20 to 28 beside n0 of 821 and more: 1.5 % of the power.
  EXPECT_NEAR(std::log10(tight.limit / slack.limit), 0.5, 0.015);
  EXPECT_NEAR(std::log10(tight.bears() / slack.bears()), 0.5, 0.015);
}

TEST(StripSnap, OfTheBuckledWallThatShipsIsWhatItsPageSays) {
  const WallSection wall{1.7 * mm, 3.0 * um, 250.0 * GPa, 0.23, -10.0 * MPa};
  EXPECT_NEAR(strip_snap(wall).limit.si(), 140.6, 0.05);
  EXPECT_NEAR(strip_snap(wall).bears().si(), 124.0, 0.5);
  EXPECT_NEAR(wall.prestress / PlateStrip::buckling_prestress(wall), 3.7, 0.05);
}

TEST(StripSnap, RefusesAStripThatIsNotBuckledOrShears) {
  EXPECT_THROW(strip_snap(nitride(Pressure{})), InputError);
  EXPECT_THROW(strip_snap(buckled(0.99)), InputError);
  EXPECT_NO_THROW(strip_snap(buckled(1.01)));
  WallSection sheared = buckled(2.0);
  sheared.shear_correction = 5.0 / 6.0;
  EXPECT_THROW(strip_snap(sheared), InputError);
}

}  // namespace
}  // namespace manoscope::wall
