#include "manoscope/flow/spectral.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>
#include <numbers>

#include "manoscope/core/error.hpp"

namespace manoscope::flow {
namespace {

/// T_k(position), k = 0 .. degree: (m, degree + 1).
Matrix chebyshev_polynomials(const Array1& positions, int degree) {
  Matrix values(positions.size(), degree + 1);
  values.col(0).setOnes();
  if (degree > 0) values.col(1) = positions;
  for (int k = 2; k <= degree; ++k) {
    values.col(k) = 2.0 * (positions * values.col(k - 1).array()).matrix() - values.col(k - 2);
  }
  return values;
}

/// Integrals of T_k from -1 to the position, k = 0 .. degree.
Matrix chebyshev_integrals(const Array1& positions, int degree) {
  const Matrix T = chebyshev_polynomials(positions, degree + 1);
  Matrix values(positions.size(), degree + 1);
  values.col(0) = (positions + 1.0).matrix();
  if (degree > 0) values.col(1) = (0.5 * (positions.square() - 1.0)).matrix();
  for (int k = 2; k <= degree; ++k) {
    const double sign = k % 2 == 0 ? 1.0 : -1.0;  // T_k(-1)
    const double up = 0.5 / (k + 1), down = 0.5 / (k - 1);
    values.col(k) =
        (up * (T.col(k + 1).array() + sign) - down * (T.col(k - 1).array() + sign)).matrix();
  }
  return values;
}

/// Nodes of [-1, 1], ascending; exactly symmetric.
Array1 lobatto_nodes(int degree) {
  Array1 nodes(degree + 1);
  for (int k = 0; k <= degree; ++k) {
    nodes(k) = std::sin(0.5 * std::numbers::pi * (2 * k - degree) / degree);
  }
  return nodes;
}

Matrix differentiation(const Array1& nodes) {
  const Index n = nodes.size();
  Matrix derivative = Matrix::Zero(n, n);
  const auto weight = [n](Index i) {
    return (i % 2 == 0 ? 1.0 : -1.0) * (i == 0 || i == n - 1 ? 2.0 : 1.0);
  };
  for (Index i = 0; i < n; ++i) {
    for (Index j = 0; j < n; ++j) {
      if (i != j) derivative(i, j) = weight(i) / weight(j) / (nodes(i) - nodes(j));
    }
    derivative(i, i) = -derivative.row(i).sum();  // constants have no slope, to round-off
  }
  return derivative;
}

Matrix integration(const Array1& nodes) {
  const int degree = static_cast<int>(nodes.size()) - 1;
  const Matrix values = chebyshev_polynomials(nodes, degree);
  return chebyshev_integrals(nodes, degree) * values.inverse();
}

}  // namespace

QuadratureRule gauss_legendre(int n) {
  MANO_ASSERT(n >= 1);
  Matrix jacobi = Matrix::Zero(n, n);
  for (int k = 1; k < n; ++k) {
    jacobi(k, k - 1) = jacobi(k - 1, k) = k / std::sqrt(4.0 * k * k - 1.0);
  }
  const Eigen::SelfAdjointEigenSolver<Matrix> solver(jacobi, Eigen::EigenvaluesOnly);
  QuadratureRule rule{solver.eigenvalues().array(), Array1(n)};
  rule.nodes = (0.5 * (rule.nodes - rule.nodes.reverse())).eval();
  for (int polish = 0; polish < 3; ++polish) {
    const Matrix P = legendre_polynomials(rule.nodes, n);
    const Array1 slope =
        n * (P.col(n - 1).array() - rule.nodes * P.col(n).array()) / (1.0 - rule.nodes.square());
    rule.weights = 2.0 / ((1.0 - rule.nodes.square()) * slope.square());
    rule.nodes -= P.col(n).array() / slope;
  }
  return rule;
}

Matrix legendre_polynomials(const Array1& positions, int degree) {
  Matrix values(positions.size(), degree + 1);
  values.col(0).setOnes();
  if (degree > 0) values.col(1) = positions;
  for (int k = 2; k <= degree; ++k) {
    values.col(k) = ((2.0 * k - 1.0) / k * positions * values.col(k - 1).array() -
                     (k - 1.0) / k * values.col(k - 2).array())
                        .matrix();
  }
  return values;
}

BubbleFunctions bubble_functions(const Array1& positions, int degree) {
  MANO_ASSERT(degree >= 2);
  const Matrix P = legendre_polynomials(positions, degree);
  BubbleFunctions bubbles{Matrix(positions.size(), degree - 1),
                          Matrix(positions.size(), degree - 1)};
  for (int k = 1; k < degree; ++k) {
    bubbles.values.col(k - 1) = (P.col(k + 1) - P.col(k - 1)) / std::sqrt(2.0 * (2.0 * k + 1.0));
    bubbles.slopes.col(k - 1) = std::sqrt(0.5 * (2.0 * k + 1.0)) * P.col(k);
  }
  return bubbles;
}

NodalBasis chebyshev_basis(int degree) {
  MANO_ASSERT(degree >= 2);
  const Array1 nodes = lobatto_nodes(degree);
  NodalBasis basis;
  basis.nodes = 0.5 * (nodes + 1.0);
  basis.derivative = 2.0 * differentiation(nodes);
  basis.integral = 0.5 * integration(nodes);
  basis.weights = basis.integral.row(degree).transpose().array();
  return basis;
}

EvenBasis even_chebyshev_basis(int n) {
  MANO_ASSERT(n >= 2);
  const Array1 nodes = lobatto_nodes(2 * n);
  const Matrix slope = differentiation(nodes);
  const Matrix bend = slope * slope;
  const Matrix integral = integration(nodes);
  // A matrix on all nodes, for functions whose left half is `parity` times the right one.
  const auto folded = [n](const Matrix& whole, double parity) {
    Matrix half = whole.bottomRightCorner(n + 1, n + 1);
    for (int j = 1; j <= n; ++j) half.col(j) += parity * whole.col(n - j).tail(n + 1);
    return half;
  };
  EvenBasis basis;
  basis.nodes = nodes.tail(n + 1);
  basis.nodes(0) = 0.0;
  basis.even_slope = folded(slope, 1.0);
  basis.odd_slope = folded(slope, -1.0);
  basis.even_bend = folded(bend, 1.0);
  Matrix from_middle = integral;
  from_middle.rowwise() -= integral.row(n);
  basis.integral = folded(from_middle, 1.0);
  basis.weights = basis.integral.row(n).transpose().array();
  // T_1, T_3, ..: n functions that n nodes beside the middle determine.
  const Matrix T = chebyshev_polynomials(basis.nodes, 2 * n - 1);
  Matrix odd(n, n);
  for (int k = 0; k < n; ++k) odd.col(k) = T.col(2 * k + 1).tail(n);
  basis.odd_transform = Matrix::Zero(n, n + 1);
  basis.odd_transform.rightCols(n) = odd.inverse();
  return basis;
}

}  // namespace manoscope::flow
