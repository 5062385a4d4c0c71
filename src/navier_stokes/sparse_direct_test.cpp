#include "sparse_direct.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "manoscope/core/error.hpp"
#include "tests/support/quiet_traps.hpp"

namespace manoscope::navier_stokes {
namespace {

/// Saddle point like a discrete Stokes problem: n unknowns with a stiffness, n/2 multipliers
/// without.
SparseMatrix saddle(int n) {
  SparseMatrix matrix;
  matrix.row_start.push_back(0);
  const auto end_row = [&] { matrix.row_start.push_back(static_cast<int>(matrix.column.size())); };
  const auto entry = [&](int column, double value) {
    matrix.column.push_back(column);
    matrix.value.push_back(value);
  };
  for (int i = 0; i < n; ++i) {
    if (i > 0) entry(i - 1, -1.0);
    entry(i, 2.0);
    if (i + 1 < n) entry(i + 1, -1.0 + 0.1 * std::sin(i));
    entry(n + i / 2, i % 2 == 0 ? 1.0 : -0.5);
    end_row();
  }
  for (int k = 0; k < n / 2; ++k) {
    entry(2 * k, 1.0);
    entry(2 * k + 1, -0.5);
    end_row();
  }
  return matrix;
}

class SparseDirectOf : public testing::TestWithParam<SparseLibrary> {
  test::QuietTraps traps_;  // both libraries divide by what may be 0 and look afterwards
};

TEST_P(SparseDirectOf, SolvesSaddlePoints) {
  SparseDirect solver(GetParam());
  for (const int n : {40, 40, 60}) {  // the pattern stays, then changes
    const SparseMatrix matrix = saddle(n);
    std::vector<double> x(static_cast<std::size_t>(matrix.size()));
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = std::cos(static_cast<double>(i));
    const std::vector<double> found = solver.solve(matrix, matrix.times(x));
    // Condition about 1e3.
    for (std::size_t i = 0; i < x.size(); ++i) EXPECT_NEAR(found[i], x[i], 1e-11);
    EXPECT_LE(solver.residual(), SparseDirect::kResidual);
  }
}

TEST_P(SparseDirectOf, GivesNoAnswerToASingularSystem) {
  SparseMatrix matrix = saddle(40);
  for (int k = matrix.row_start[50]; k < matrix.row_start[51]; ++k) matrix.value[k] = 0.0;
  SparseDirect solver(GetParam());
  EXPECT_THROW(solver.solve(matrix, std::vector<double>(60, 1.0)), InternalError);
}

TEST_P(SparseDirectOf, AnswersZeroWithZero) {
  EXPECT_EQ(SparseDirect(GetParam()).solve(saddle(8), std::vector<double>(12, 0.0)),
            std::vector<double>(12, 0.0));
}

INSTANTIATE_TEST_SUITE_P(Libraries, SparseDirectOf,
                         testing::Values(SparseLibrary::mumps, SparseLibrary::umfpack),
                         [](const auto& given) {
                           return given.param == SparseLibrary::mumps ? "Mumps" : "Umfpack";
                         });

}  // namespace
}  // namespace manoscope::navier_stokes
