#pragma once

#include <Eigen/Core>
#include <functional>

#include "manoscope/core/arrays.hpp"

namespace manoscope::numerics {

/// A measurement model: (n) input quantities to (m) output quantities.
using Model = std::function<Eigen::VectorXd(const Eigen::VectorXd&)>;

struct Interval {
  double low = 0.0, high = 0.0;
  double width() const { return high - low; }
};

/// Estimates of n input quantities.
struct Estimates {
  Eigen::VectorXd value;  ///< (n)
  Matrix covariance;      ///< (n, n), standard uncertainties squared on the diagonal
  /// (n) degrees of freedom of the standard uncertainties, infinite where exactly known; empty =
  /// all exactly known.
  Eigen::VectorXd degrees_of_freedom;

  /// Independent estimates with standard uncertainties `sigma`.
  static Estimates independent(const Eigen::VectorXd& value, const Eigen::VectorXd& sigma,
                               const Eigen::VectorXd& degrees_of_freedom = {});
  /// The mean of simultaneous observations, one a row: covariances of means by GUM eq. 17, n - 1
  /// degrees of freedom.
  static Estimates mean_of(const Matrix& observations);

  /// @throws InputError if shapes differ, a number is not finite, or the covariance is not
  ///         symmetric with a diagonal not below 0.
  void validate() const;
};

struct LinearOptions {
  /// (m, n) derivatives of the outputs by the inputs at a point; empty = central differences.
  std::function<Matrix(const Eigen::VectorXd&)> sensitivity;
  /// Adds the terms of next higher order (GUM 5.1.2, note) to the variances; independent inputs
  /// with distributions symmetric as a normal one.
  bool second_order = false;
};

/// Estimates of m output quantities by linear propagation.
struct LinearResult {
  Eigen::VectorXd value;               ///< (m) the model at the estimates
  Matrix sensitivity;                  ///< (m, n) derivatives by the inputs
  Matrix covariance;                   ///< (m, m)
  Eigen::VectorXd degrees_of_freedom;  ///< (m) effective; infinite if all inputs' are

  Eigen::VectorXd sigma() const { return covariance.diagonal().cwiseSqrt(); }
  Matrix correlation() const;
  /// Coverage interval value +- k sigma of one output, k by coverage_factor().
  /// @param coverage  Probability in (0, 1).
  Interval interval(Index output, double coverage) const;
};

/// Law of propagation of uncertainty.
///
///   covariance = C V C^T,   C_ij = df_i/dx_j
///   nu_i = u_i^4 / sum_g (u_ig^4 / nu_g),   u_ig^2 = C_ig V_g C_ig^T
///
/// Source: JCGM 100:2008 (GUM) eqs. 10 and 13, for several outputs JCGM 102:2011 6.2; effective
/// degrees of freedom: Welch-Satterthwaite, GUM eq. G.2b, over groups g of inputs that are
/// independent from one another, and within a group have one number of degrees of freedom
/// (Willink 2007, Metrologia 44, 340). With `second_order`, variances also take
/// sum_ij (f_ij^2/2 + f_i f_ijj) u_i^2 u_j^2.
///
/// Central differences over 1/100 and 1/200 of each standard uncertainty, extrapolated: relative
/// error of a sensitivity below 1e-9 where the model is smooth over one standard uncertainty and
/// computed to 1e-16 of an output not above 1e4 of its standard uncertainty.
///
/// @throws InputError if the estimates are bad, or correlated ones differ in their degrees of
///         freedom, or are given together with `second_order`.
LinearResult propagate_linearly(const Model& model, const Estimates& inputs,
                                const LinearOptions& options = {});

/// k with P(|t| <= k) = coverage of a t distribution (GUM annex G); infinite degrees of freedom: of
/// the normal distribution.
double coverage_factor(double coverage, double degrees_of_freedom);

/// Numerical tolerance of a standard uncertainty of which `digits` significant decimal digits are
/// meaningful: sigma = c 10^l with an integer c of that many digits, tolerance 10^l / 2 (JCGM
/// 101:2008, 7.9.2).
/// @throws InputError if sigma is not above 0 or digits is outside 1..8.
double numerical_tolerance(double sigma, int digits);

/// Whether the linear result stands in for a Monte Carlo one (JCGM 101:2008, 8.1).
struct LinearValidation {
  double tolerance = 0.0;            ///< numerical_tolerance() of the standard uncertainty
  double d_low = 0.0, d_high = 0.0;  ///< distances of the end points of the two intervals
  bool valid = false;                ///< neither distance exceeds the tolerance
};

/// Compares two coverage intervals of the same quantity and coverage probability. The Monte Carlo
/// one should be stable to a fifth of the tolerance (8.2); see MonteCarloOptions.
LinearValidation validate_linear(const Interval& linear, const Interval& monte_carlo, double sigma,
                                 int digits);

}  // namespace manoscope::numerics
