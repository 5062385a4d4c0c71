#include "manoscope/wall/block_tridiagonal.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

namespace manoscope::wall {
namespace {

/// A symmetric matrix of uneven blocks without structure; `shift` moves its eigenvalues.
BlockTridiagonal example(double shift) {
  BlockTridiagonal made({3, 5, 2, 4});
  int seed = 1;
  const auto next = [&seed] {
    seed = (seed * 37 + 11) % 101;
    return seed / 50.0 - 1.0;
  };
  for (Matrix& block : made.diagonal) {
    for (Index i = 0; i < block.rows(); ++i) {
      for (Index j = 0; j <= i; ++j) block(i, j) = block(j, i) = next();
      block(i, i) += shift;
    }
  }
  for (Matrix& block : made.below) {
    for (double& entry : block.reshaped()) entry = next();
  }
  return made;
}

Matrix dense(const BlockTridiagonal& matrix) {
  Matrix made = Matrix::Zero(14, 14);
  for (Index k = 0; k < 14; ++k) made.col(k) = matrix.multiply(Eigen::VectorXd::Unit(14, k));
  return made;
}

TEST(BlockFactorisation, SolvesDefiniteAndIndefiniteMatricesAndCountsNegativeEigenvalues) {
  for (const double shift : {9.0, 1.0, 0.0, -9.0}) {
    const BlockTridiagonal matrix = example(shift);
    const Matrix whole = dense(matrix);
    ASSERT_LT((whole - whole.transpose()).norm(), 1e-14);
    const Eigen::SelfAdjointEigenSolver<Matrix> eigen(whole);
    const BlockFactorisation factored(matrix);
    EXPECT_EQ(factored.n_negative(), (eigen.eigenvalues().array() < 0.0).count());
    Matrix x = Matrix::Identity(14, 14);
    factored.solve_in_place(x);
    // Round-off times the condition number, which is below 1e3 here.
    EXPECT_LT((whole * x - Matrix::Identity(14, 14)).norm(), 1e-11) << shift;
  }
}

}  // namespace
}  // namespace manoscope::wall
