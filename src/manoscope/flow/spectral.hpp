#pragma once

#include "manoscope/core/arrays.hpp"

namespace manoscope::flow {

/// Nodes and weights of a quadrature rule.
struct QuadratureRule {
  Array1 nodes, weights;
};

/// Gauss-Legendre rule on [-1, 1], exact for polynomials of degree 2 n - 1.
///
/// Source: Golub & Welsch, Math. Comput. 23 (1969) 221: eigenvalues of the Jacobi matrix, each then
/// polished by Newton steps on P_n to round-off.
/// @param n  number of nodes, >= 1.
QuadratureRule gauss_legendre(int n);

/// Legendre polynomials P_0 .. P_degree at the positions: (m, degree + 1).
Matrix legendre_polynomials(const Array1& positions, int degree);

/// Integrated Legendre polynomials, which vanish at both ends of [-1, 1], and their slopes.
///
///   phi_k = (P_{k+1} - P_{k-1}) / sqrt(2 (2 k + 1)),  phi_k' = sqrt((2 k + 1)/2) P_k,
///   k = 1 .. degree - 1
///
/// phi_k is even for odd k. Source: Szabo & Babuska, Finite Element Analysis (1991), ch. 3.
struct BubbleFunctions {
  Matrix values;  ///< (m, degree - 1)
  Matrix slopes;  ///< (m, degree - 1)
};
BubbleFunctions bubble_functions(const Array1& positions, int degree);

/// Polynomials by their values at Chebyshev-Lobatto nodes of [0, 1], ascending.
struct NodalBasis {
  Array1 nodes;       ///< (n + 1)
  Matrix derivative;  ///< (n + 1, n + 1): values to slopes
  Matrix integral;    ///< (n + 1, n + 1): values to the integral from 0 to each node
  Array1 weights;     ///< (n + 1): integral over [0, 1]
};

/// Source: Trefethen, Spectral Methods in MATLAB (2000), ch. 6 and 12. Exact for polynomials of the
/// degree.
NodalBasis chebyshev_basis(int degree);

/// Even functions on [-1, 1] by their values at the Chebyshev-Lobatto nodes of [0, 1] there.
struct EvenBasis {
  Array1 nodes;          ///< (n + 1) on [0, 1], ascending from 0
  Matrix even_slope;     ///< derivative of an even function (an odd one)
  Matrix odd_slope;      ///< derivative of an odd function (an even one)
  Matrix even_bend;      ///< second derivative of an even function
  Matrix integral;       ///< of an even function, from 0 to each node
  Matrix odd_transform;  ///< values of an odd function to its coefficients of T_1, T_3, ...
  Array1 weights;        ///< integral over [0, 1]
};

/// @param n  number of nodes less one; the polynomials are of degree 2 n.
EvenBasis even_chebyshev_basis(int n);

}  // namespace manoscope::flow
