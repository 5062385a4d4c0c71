// The flow around a cylinder in a channel, against published values; forces on what stands in it.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "flow_solver.hpp"
#include "tests/support/quiet_traps.hpp"

namespace manoscope::navier_stokes {
namespace {

/// Benchmark DFG 2D-1 in diameters of the cylinder and mean velocities: a channel 22 by 4.1, the
/// middle of the cylinder at (2, 2), Re = 20. M. Schaefer & S. Turek, Notes on Numerical Fluid
/// Mechanics 52 (1996) 547.
constexpr double kLength = 22.0, kHeight = 4.1, kCentre = 2.0, kRadius = 0.5, kReynolds = 20.0;

/// The hole in the lattice is a square of this half side; 0.66 makes the three angles at each of
/// the circle's corners about equal.
constexpr double kHole = 0.66;
/// Half side of the square beyond which charts are places.
constexpr double kNear = 1.5;

/// Place of a chart: the hole becomes a disc, eight blocks around it are blended between circle and
/// square. It bends only at the edges of blocks.
Vector<2> around_cylinder(const Vector<2>& chart) {
  const Vector<2> from{chart[0] - kCentre, chart[1] - kCentre};
  const Vector<2> size{std::abs(from[0]), std::abs(from[1])};
  if (std::max(size[0], size[1]) >= kNear) return chart;
  const auto share = [](double s) { return std::max(0.0, (s - kHole) / (kNear - kHole)); };
  const auto angle = [](double s) {  // from the nearest axis
    return 0.25 * std::numbers::pi * std::min(1.0, s / kHole);
  };
  Vector<2> place;
  if (size[1] <= kHole || size[0] <= kHole) {  // beside it
    const int away = size[1] <= kHole ? 0 : 1, along = 1 - away;
    const double t = share(size[away]), a = angle(size[along]);
    place[away] = (1.0 - t) * kRadius * std::cos(a) + t * kNear;
    place[along] = (1.0 - t) * kRadius * std::sin(a) + t * size[along];
  } else {  // at a corner
    const Vector<2> t{share(size[0]), share(size[1])};
    const double corner = kRadius * std::numbers::sqrt2 / 2.0;
    for (const int axis : {0, 1}) {
      const double low = (1.0 - t[axis]) * corner + t[axis] * kNear;
      const double high = (1.0 - t[axis]) * kHole + t[axis] * kNear;
      place[axis] = (1.0 - t[1 - axis]) * low + t[1 - axis] * high;
    }
  }
  for (const int axis : {0, 1}) place[axis] = kCentre + std::copysign(place[axis], from[axis]);
  return place;
}

void add_even(std::vector<double>& edges, double to, int n) {
  const double from = edges.back();
  for (int i = 1; i <= n; ++i) edges.push_back(from + (to - from) * i / n);
}

/// Edges to the hole and behind it; cells shrink towards it.
void add_near(std::vector<double>& edges, int n) {
  constexpr double kGrowth = 2.0;  // of cells with the square of the distance
  const auto distance = [&](int i) {
    const double s = static_cast<double>(i) / n;
    return kHole + (kNear - kHole) * (s + kGrowth * s * s) / (1.0 + kGrowth);
  };
  for (int i = n - 1; i >= 0; --i) edges.push_back(kCentre - distance(i));
  add_even(edges, kCentre + kHole, n);
  for (int i = 1; i <= n; ++i) edges.push_back(kCentre + distance(i));
}

struct Benchmark {
  double drag = 0.0, lift = 0.0, pressure_drop = 0.0;
};

/// @param n  cells along a quarter of the circle.
Benchmark flow_around_cylinder(int order, int n) {
  FlowProblem<2> problem;
  auto& [x, y] = problem.edges;
  x = y = {0.0};
  for (auto* edges : {&x, &y}) {
    add_even(*edges, kCentre - kNear, n / 2);
    add_near(*edges, n);
  }
  add_even(y, kHeight, n / 2);
  // Behind it cells grow from 0.35 to 3 diameters.
  const double start = x.back(), growth = std::pow(8.0, 1.0 / (3 * n));
  for (int i = 1; i <= 3 * n; ++i) {
    x.push_back(start + (kLength - start) * (std::pow(growth, i) - 1.0) / 7.0);
  }
  problem.place = around_cylinder;
  problem.solid = [](const Vector<2>& chart) {
    return std::abs(chart[0] - kCentre) < kHole && std::abs(chart[1] - kCentre) < kHole;
  };
  problem.reynolds = kReynolds;
  problem.order = order;
  problem.sides[SideName::inlet] = {SideCondition::velocity, [](const Vector<2>& at) {
                                      const double t = at[1] / kHeight;
                                      return Vector<2>{6.0 * t * (1.0 - t), 0.0};
                                    }};
  problem.sides[SideName::outlet].condition = SideCondition::open;
  FlowSolver<2> solver(problem);
  solver.solve();
  // Coefficients: forces over rho U^2 D / 2; they are in eta U, and eta/(rho U D) = 1/Re.
  const Vector<2> force = solver.force_on_solids();
  // Where the axis of the channel's x meets the circle, from without.
  const double front = std::nextafter(kCentre - kHole, 0.0);
  const double drop =
      solver.at({front, kCentre}).pressure - solver.at({kCentre + kHole, kCentre}).pressure;
  // In rho times m^2/s^2, as published: U = 0.2 m/s.
  return {2.0 * force[0] / kReynolds, 2.0 * force[1] / kReynolds, 0.2 * 0.2 * drop / kReynolds};
}

class CylinderFlow : public testing::Test {
  test::QuietTraps traps_;  // MUMPS scales rows by what may be 0 / 0
};

/// Expects the published values to within shares of them.
void expect_published(const Benchmark& found, const Benchmark& tolerance) {
  // G. Nabh, Preprint 42/98, University of Heidelberg (1998), by a spectral method; digits as on
  // the page of the benchmark (featflow.de).
  constexpr Benchmark kPublished{5.57953523384, 0.010618948146, 0.11752016697};
  const auto expect = [](const char* what, double value, double published, double share) {
    // Leaves the figures of docs/simulation.md in the output of the tests.
    testing::Test::RecordProperty(what, fmt::format("{:.9f}", value));
    EXPECT_NEAR(value / published, 1.0, share) << what;
  };
  expect("drag", found.drag, kPublished.drag, tolerance.drag);
  expect("lift", found.lift, kPublished.lift, tolerance.lift);
  expect("pressure_drop", found.pressure_drop, kPublished.pressure_drop, tolerance.pressure_drop);
}

TEST_F(CylinderFlow, HasThePublishedDragLiftAndPressureDrop) {
  // Pressure at a point converges slowest: the four cells on a quarter leave 3e-4 of it.
  expect_published(flow_around_cylinder(3, 4), {1e-4, 1e-3, 1e-3});
}

/// `make simulation-check` runs it.
TEST_F(CylinderFlow, DISABLED_HasThePublishedValuesToTheirDigitsOnAFineMesh) {
  expect_published(flow_around_cylinder(4, 6), {1e-7, 2e-6, 1e-4});
}

/// A box filled with fluid at rest under a weight of 3 along -y, with one block in it.
template <int dim>
Vector<dim> force_on_block_at_rest(const Vector<dim>& size) {
  FlowProblem<dim> problem;
  for (int axis = 0; axis < dim; ++axis) problem.edges[axis] = {0.0, 1.0, 1.0 + size[axis], 4.0};
  problem.place = [](const Vector<dim>& chart) { return chart; };
  problem.solid = [size](const Vector<dim>& chart) {
    bool inside = true;
    for (int axis = 0; axis < dim; ++axis) {
      inside = inside && chart[axis] > 1.0 && chart[axis] < 1.0 + size[axis];
    }
    return inside;
  };
  problem.force = [](const Vector<dim>&) {
    Vector<dim> weight{};
    weight[1] = -3.0;
    return weight;
  };
  FlowSolver<dim> solver(problem);
  solver.solve();
  return solver.force_on_solids();
}

TEST_F(CylinderFlow, FluidAtRestLiftsABlockByTheWeightOfWhatItTakesAway) {
  const Vector<2> plane = force_on_block_at_rest<2>({0.5, 2.0});
  EXPECT_NEAR(plane[0], 0.0, 1e-10);  // round-off of the solve
  EXPECT_NEAR(plane[1], 3.0 * 0.5 * 2.0, 1e-10);
  const Vector<3> space = force_on_block_at_rest<3>({0.5, 2.0, 1.25});
  EXPECT_NEAR(space[0], 0.0, 1e-10);
  EXPECT_NEAR(space[1], 3.0 * 0.5 * 2.0 * 1.25, 1e-10);
  EXPECT_NEAR(space[2], 0.0, 1e-10);
}

}  // namespace
}  // namespace manoscope::navier_stokes
