#include "manoscope/inversion/wall_response.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "manoscope/core/error.hpp"

namespace manoscope::inversion {
namespace {

/// A nitride wall under tension that dwarfs its stretching and its bending.
wall::ClampedWall taut() { return {12.0 * mm, 1.0 * mm, 0.5 * um, 200.0 * GPa, 0.25, 800.0 * MPa}; }

Array1 some_levels() { return Array1::LinSpaced(4, 0.0, 3000.0); }

TEST(ResponseNodes, ReachFromEndToEndAndAreDenseThere) {
  const Array1 nodes = response_nodes(15.5 * mm, 1.7 * mm);
  const Index n = nodes.size();
  EXPECT_EQ(nodes[0], 0.0);
  EXPECT_DOUBLE_EQ(nodes[n - 1], 15.5e-3);
  const Array1 step = nodes.tail(n - 1) - nodes.head(n - 1);
  EXPECT_GT(step.minCoeff(), 0.0);
  EXPECT_LT(step[0], 0.04 * 1.7e-3);
  EXPECT_LT(step.maxCoeff(), 0.125 * 1.7e-3);
  EXPECT_LT((nodes + nodes.reverse() - 15.5e-3).abs().maxCoeff(), 1e-15);
}

TEST(WallResponse, ReadsUniformPressureAsItIs) {
  const WallResponse response(taut(), some_levels(), {});
  const Index n = response.nodes().size();
  const auto answer = response.answer(Eigen::VectorXd::Constant(n, 1700.0));
  // p(zeta) of this wall is a cubic to 1e-6 of its stretching part.
  EXPECT_LT((answer.reading.array() - 1700.0).abs().maxCoeff(), 0.01);
  const Array1 sums = answer.kernel.rowwise().sum();
  EXPECT_LT((sums - 1.0).abs().maxCoeff(), 1e-4);
}

TEST(WallResponse, KernelIsTheDerivativeOfTheReading) {
  const WallResponse response(taut(), some_levels(), {});
  const Array1 s = response.nodes() / 12e-3;
  const Eigen::VectorXd p = (2500.0 - 2000.0 * s * s).matrix();
  const auto at = response.answer(p);
  Eigen::VectorXd change = Eigen::VectorXd::Zero(p.size());
  change.segment(p.size() / 3, 5).setConstant(50.0);
  const Eigen::VectorXd difference =
      response.answer(p + change).reading - response.answer(p - change).reading;
  const Eigen::VectorXd expected = 2.0 * at.kernel * change;
  EXPECT_GT(expected.cwiseAbs().maxCoeff(), 10.0);
  // Third order in 50 Pa of a wall that bends its curve by percents over 2 kPa.
  EXPECT_LT((difference - expected).cwiseAbs().maxCoeff(), 1e-3 * expected.cwiseAbs().maxCoeff());
}

TEST(WallResponse, OfATautWallShowsHalfOfARippleTwoWidthsLong) {
  // zeta - L^2 zeta'' = c p with L = w/pi: 1/(1 + (2 pi L/lambda)^2) is 1/2 at lambda = 2 w. The
  // higher modes across, which the average sees less, shorten it by some percent.
  const WallResponse response(taut(), some_levels(), {});
  const Index n = response.nodes().size();
  const auto answer = response.answer(Eigen::VectorXd::Constant(n, 1000.0));
  EXPECT_NEAR(response.half_wavelength(answer.kernel, n / 2) / 2e-3, 1.0, 0.06);
}

TEST(WallResponse, OfAWallThatFallsWithPressureIsRefused) {
  // Compressed to three times what buckles it, with a shape that starts it downward: it snaps.
  wall::ClampedWall wall{4.0 * mm, 1.0 * mm, 3.0 * um, 250.0 * GPa, 0.25, -24.0 * MPa};
  wall.initial_shape = {-4.0 * um, 0.02};
  EXPECT_THROW(WallResponse(wall, Array1::LinSpaced(5, 0.0, 4000.0), {}), InputError);
}

}  // namespace
}  // namespace manoscope::inversion
