#include "manoscope/wall/fvk_model.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace manoscope::wall {
namespace {

using Vector = Eigen::VectorXd;

/// A deterministic state without symmetry, entries in [-1, 1].
Vector rough(Index n, int seed) {
  Vector made(n);
  for (double& entry : made) {
    seed = (seed * 421 + 1663) % 7875;
    entry = seed / 3937.0 - 1.0;
  }
  return made;
}

FvkModel example(bool symmetric, double shear) {
  FvkModel model(HermiteAxis(graded_nodes(0.0, 3.0, RefinedEnds::both, 0.1, 1.0, 6)),
                 HermiteAxis(symmetric ? graded_nodes(0.0, 1.0, RefinedEnds::last, 0.1, 1.0, 3)
                                       : graded_nodes(-1.0, 1.0, RefinedEnds::both, 0.1, 1.0, 4)),
                 {0.3, 0.7, shear}, symmetric);
  model.set_initial_shape(0.2 * rough(model.n_unknowns(), 5));
  return model;
}

// The energy is a polynomial of degree four: a five-point difference is exact but for round-off,
// about 1e-16/1e-2 relative.
TEST(FvkModel, GradientIsThatOfTheEnergyAndHessianThatOfTheGradient) {
  for (const bool symmetric : {true, false}) {
    for (const double shear : {0.0, 2.5}) {
      const FvkModel model = example(symmetric, shear);
      const Vector q = rough(model.n_unknowns(), 1), d = rough(model.n_unknowns(), 2);
      const double h = 0.05;
      const auto slope = [h](const auto& f) {
        auto sum = f(h);
        sum -= f(-h);
        sum *= 8.0;
        sum -= f(2.0 * h);
        sum += f(-2.0 * h);
        sum /= 12.0 * h;
        return sum;
      };
      const double by_energy = slope([&](double s) { return model.energy(q + s * d); });
      EXPECT_NEAR(by_energy / model.gradient(q).dot(d), 1.0, 1e-9);
      const Vector by_gradient =
          slope([&](double s) -> Vector { return model.gradient(q + s * d); });
      BlockTridiagonal hessian(model.block_sizes());
      model.add_hessian(q, hessian);
      EXPECT_LT((hessian.multiply(d) - by_gradient).norm() / by_gradient.norm(), 1e-11);
    }
  }
}

TEST(FvkModel, HessianDependsOnThePrestressThroughTheGeometricStiffness) {
  const FvkModel model = example(true, 2.5);
  const FvkModel slack(model.x(), model.z(), {0.3, 0.0, 2.5}, true);
  const Vector q = rough(model.n_unknowns(), 1), d = rough(model.n_unknowns(), 2);
  BlockTridiagonal with(model.block_sizes()), without(model.block_sizes());
  model.add_hessian(q, with);
  slack.add_hessian(q, without);
  FvkModel shaped = slack;
  shaped.set_initial_shape(model.initial_shape());
  without.set_zero();
  shaped.add_hessian(q, without);
  shaped.add_geometric_stiffness(without);
  BlockTridiagonal rest(model.block_sizes());
  shaped.add_geometric_stiffness(rest);
  without.add(0.7 - 1.0, rest);
  EXPECT_LT((with.multiply(d) - without.multiply(d)).norm(), 1e-12 * with.multiply(d).norm());
}

}  // namespace
}  // namespace manoscope::wall
