#include "manoscope/validation/across_modes.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>

#include "manoscope/core/error.hpp"

namespace manoscope::validation {
namespace {

/// Legendre's polynomials P_0 .. P_degree, one a column, coefficients of 1, s, s^2, ..
Matrix legendre(Index degree) {
  Matrix p = Matrix::Zero(degree + 1, degree + 1);
  p(0, 0) = 1.0;
  if (degree > 0) p(1, 1) = 1.0;
  for (Index k = 1; k < degree; ++k) {
    const auto n = static_cast<double>(k);
    p.col(k + 1).tail(degree) = (2.0 * n + 1.0) / (n + 1.0) * p.col(k).head(degree);
    p.col(k + 1) -= n / (n + 1.0) * p.col(k - 1);
  }
  return p;
}

/// Mean of s^i over the width.
double mean_of_power(Index i) { return i % 2 == 0 ? 1.0 / static_cast<double>(i + 1) : 0.0; }

/// (n) polynomials times 1 - s^2, of every second degree from `first`.
Matrix clamped(Index first, Index n, Index rows) {
  const Index top = std::max<Index>(first + 2 * (n - 1), 0);
  const Matrix p = legendre(top);
  Matrix result = Matrix::Zero(rows, n);
  for (Index k = 0; k < n; ++k) {
    result.col(k).head(top + 1) += p.col(first + 2 * k);
    result.col(k).segment(2, top + 1) -= p.col(first + 2 * k);
  }
  return result;
}

/// Orthonormal combinations of the columns, those that round-off alone tells apart left out.
Matrix orthonormal(const Matrix& columns) {
  constexpr double kRoundOff = 1e-9;
  if (columns.cols() == 0) return columns;
  const Index rows = columns.rows();
  Matrix products(rows, rows);
  for (Index i = 0; i < rows; ++i) {
    for (Index j = 0; j < rows; ++j) products(i, j) = mean_of_power(i + j);
  }
  const Eigen::SelfAdjointEigenSolver<Matrix> modes(
      Matrix(columns.transpose() * products * columns));
  const Eigen::VectorXd& sizes = modes.eigenvalues();  // ascending
  const double least = kRoundOff * sizes[sizes.size() - 1];
  const Index kept = (sizes.array() > least).count();
  return columns * modes.eigenvectors().rightCols(kept) *
         sizes.tail(kept).cwiseSqrt().cwiseInverse().asDiagonal();
}

}  // namespace

AcrossModes::AcrossModes(const flow::WallShape& shape, Index n_even, Index n_odd) {
  MANO_ASSERT(n_even >= 1 && n_odd >= 0);
  const auto& even_powers = shape.coefficients();
  const auto of_shape = 2 * static_cast<Index>(even_powers.size()) - 1;
  const Index rows = std::max({of_shape, 2 * n_even + 3, 2 * n_odd + 2});
  Eigen::VectorXd g = Eigen::VectorXd::Zero(rows);
  for (std::size_t k = 0; k < even_powers.size(); ++k) {
    g[2 * static_cast<Index>(k)] = even_powers[k];
  }
  Matrix even = clamped(0, n_even + 1, rows);
  for (auto column : even.colwise()) {
    double mean = 0.0;
    for (Index i = 0; i < rows; ++i) mean += column[i] * mean_of_power(i);
    column -= mean * g;
  }
  even = orthonormal(even);
  const Matrix odd = n_odd > 0 ? orthonormal(clamped(1, n_odd, rows)) : Matrix(rows, 0);
  n_even_ = even.cols();
  powers_ = Matrix(rows, 1 + even.cols() + odd.cols());
  powers_ << g, even, odd;
}

Matrix AcrossModes::at(const Array1& s) const {
  Matrix powers(s.size(), powers_.rows());
  powers.col(0).setOnes();
  for (Index i = 1; i < powers.cols(); ++i) {
    powers.col(i) = powers.col(i - 1).cwiseProduct(s.matrix());
  }
  return powers * powers_;
}

Matrix AcrossModes::slopes(const Array1& s) const {
  Matrix powers = Matrix::Zero(s.size(), powers_.rows());
  Array1 power = Array1::Ones(s.size());
  for (Index i = 1; i < powers.cols(); ++i) {
    powers.col(i) = static_cast<double>(i) * power.matrix();
    power *= s;
  }
  return powers * powers_;
}

Matrix AcrossModes::means(const Array1& edges) const {
  const Index n = edges.size() - 1;
  Matrix powers(n, powers_.rows());
  Array1 power = Array1::Ones(n + 1);
  for (Index i = 0; i < powers.cols(); ++i) {
    power *= edges;
    powers.col(i) = ((power.tail(n) - power.head(n)) / (edges.tail(n) - edges.head(n))).matrix() /
                    static_cast<double>(i + 1);
  }
  return powers * powers_;
}

}  // namespace manoscope::validation
