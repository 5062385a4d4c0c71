#include "linear_solver.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "processes.hpp"
#include "tests/support/quiet_traps.hpp"

namespace manoscope::navier_stokes {
namespace {

/// Saddle point like a discrete Stokes problem: n unknowns with a stiffness, n/2 multipliers
/// without; the last of them without any equation if `singular`.
class Saddle {
 public:
  explicit Saddle(int n, bool singular = false) {
    const int size = n + n / 2;
    MatCreateSeqAIJ(PETSC_COMM_SELF, size, size, 6, nullptr, &matrix);
    MatSetOption(matrix, MAT_NEW_NONZERO_ALLOCATION_ERR, PETSC_FALSE);
    const auto entry = [&](int row, int column, double value) {
      MatSetValue(matrix, row, column, value, INSERT_VALUES);
    };
    for (int i = 0; i < n; ++i) {
      if (i > 0) entry(i, i - 1, -1.0);
      entry(i, i, 2.0);
      if (i + 1 < n) entry(i, i + 1, -1.0 + 0.1 * std::sin(i));
      entry(i, n + i / 2, i % 2 == 0 ? 1.0 : -0.5);
    }
    for (int k = 0; k < n / 2; ++k) {
      const double scale = singular && k == n / 2 - 1 ? 0.0 : 1.0;
      entry(n + k, 2 * k, scale);
      entry(n + k, 2 * k + 1, -0.5 * scale);
      entry(n + k, n + k, 0.0);
    }
    MatAssemblyBegin(matrix, MAT_FINAL_ASSEMBLY);
    MatAssemblyEnd(matrix, MAT_FINAL_ASSEMBLY);
    MatCreateVecs(matrix, &exact, &right);
    VecDuplicate(exact, &found);
    for (int i = 0; i < size; ++i) VecSetValue(exact, i, std::cos(i), INSERT_VALUES);
    VecAssemblyBegin(exact);
    VecAssemblyEnd(exact);
    MatMult(matrix, exact, right);
  }
  ~Saddle() {
    for (Vec* vector : {&exact, &right, &found}) VecDestroy(vector);
    MatDestroy(&matrix);
  }
  Saddle(const Saddle&) = delete;
  Saddle& operator=(const Saddle&) = delete;

  /// Largest error of what was found.
  double error() const {
    VecAXPY(found, -1.0, exact);
    double largest = 0.0;
    VecNorm(found, NORM_INFINITY, &largest);
    return largest;
  }

  Mat matrix = nullptr;
  Vec exact = nullptr, right = nullptr, found = nullptr;
};

class LinearSolverTest : public testing::Test {
 protected:
  LinearSolverTest() { Processes::all(); }

 private:
  test::QuietTraps traps_;  // MUMPS divides by what may be 0 and looks afterwards
};

TEST_F(LinearSolverTest, SolvesSaddlePoints) {
  const auto solver = direct_solver(PETSC_COMM_SELF);
  const Saddle system(40);
  for (int i = 0; i < 2; ++i) {  // the analysis is used again
    ASSERT_TRUE(solver->solve(system.matrix, system.right, system.found));
    EXPECT_LT(system.error(), 1e-11);  // condition about 1e3
    EXPECT_LE(solver->residual(), 1e-9);
    MatScale(system.matrix, 2.0);
    VecScale(system.right, 2.0);
  }
}

TEST_F(LinearSolverTest, GivesNoAnswerToASingularSystem) {
  const Saddle system(40, true);
  VecSet(system.right, 1.0);
  EXPECT_FALSE(direct_solver(PETSC_COMM_SELF)->solve(system.matrix, system.right, system.found));
}

TEST_F(LinearSolverTest, AnswersZeroWithZero) {
  const Saddle system(8);
  VecSet(system.right, 0.0);
  EXPECT_TRUE(direct_solver(PETSC_COMM_SELF)->solve(system.matrix, system.right, system.found));
  double size = 1.0;
  VecNorm(system.found, NORM_2, &size);
  EXPECT_EQ(size, 0.0);
}

}  // namespace
}  // namespace manoscope::navier_stokes
