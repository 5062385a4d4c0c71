#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <optional>

#include "manoscope/core/arrays.hpp"

namespace manoscope::numerics {

/// Parameters that make a sum of squared residuals least.
struct LeastSquaresProblem {
  /// Gives (n) residuals at (k) parameters, already of the size n; false where they do not exist.
  /// What is not finite counts as not existing.
  std::function<bool(const Eigen::VectorXd& parameters, Eigen::VectorXd& residuals)> residuals;
  /// Gives the (n, k) derivatives of the residuals; empty = differences by Ridders' method, which
  /// may call `residuals` up to 1 % of a parameter beyond its bounds.
  std::function<bool(const Eigen::VectorXd& parameters, Matrix& jacobian)> jacobian;
  Index n_residuals = 0;
  Eigen::VectorXd start;         ///< (k)
  Eigen::VectorXd lower, upper;  ///< (k) bounds, infinite ones allowed; empty = none

  /// @throws InputError if shapes differ, residuals are fewer than parameters, the start is not
  ///         finite or outside the bounds.
  void validate() const;
};

struct LeastSquaresOptions {
  int max_iterations = 1000;
  /// Relative change of the parameters, and of the sum of squares squared, at which it ends.
  double tolerance = 1e-12;

  /// @throws InputError naming the first option out of range.
  void validate() const;
};

struct LeastSquaresFit {
  Eigen::VectorXd parameters;   ///< (k)
  Eigen::VectorXd residuals;    ///< (n)
  Matrix jacobian;              ///< (n, k)
  double sum_of_squares = 0.0;  ///< of the residuals
  Index n_dof = 0;              ///< n - k
  /// (k, k) of the parameters for residuals of standard deviation 1, (J^T J)^-1; none where the
  /// residuals do not tell all parameters apart. A parameter at a bound counts as free.
  std::optional<Matrix> covariance;
  /// The solver came to rest, or a step could take away less than 1e-6 of the residuals.
  bool converged = false;

  /// Standard deviation of a residual as the residuals tell it, sqrt(sum of squares/(n - k)).
  /// @throws InternalError if n_dof is 0.
  double residual_sigma() const;
  /// (k) standard uncertainties with residuals of that standard deviation; none without covariance.
  std::optional<Eigen::VectorXd> scaled_sigma() const;
};

/// Nonlinear least squares from one start: a local minimum.
///
/// Levenberg-Marquardt of Ceres (dense QR, columns scaled), inside the bounds; then Gauss-Newton
/// steps by an orthogonal factorisation for as long as they lower the sum of squares, for the last
/// digits. Derivatives by Ridders' method (Ridders 1982, Adv. Eng. Software 4, 75). Parameters
/// whose columns of the Jacobian, brought to length 1, depend on one another to 1e-11 are not told
/// apart.
///
/// Accuracy: see fit_from_many_starts().
///
/// @return The fit, or none if the residuals do not exist at the start.
/// @throws InputError if problem or options are bad.
std::optional<LeastSquaresFit> fit_least_squares(const LeastSquaresProblem& problem,
                                                 const LeastSquaresOptions& options = {});

struct MultiStartOptions {
  int most_starts = 100;  ///< in all, the given one first
  /// Ends when as many starts have come to the same, lowest sum of squares, provided that it does
  /// not leave a parameter uncertain by more than a thousand times itself.
  int agreeing = 5;
  /// Scale of the standard deviation s of ln(|start|) of further starts: 1.5, 0.5, 0.1 and 1 times
  /// it in turn.
  double spread = 1.0;
  std::uint64_t seed = 1;
  LeastSquaresOptions each;

  /// @throws InputError naming the first option out of range.
  void validate() const;
};

struct MultiStartFit {
  LeastSquaresFit best;
  int n_starts = 0;    ///< that were tried
  int n_agreeing = 0;  ///< that came to the best one's sum of squares
};

/// The least of the minima found from the given start and from further ones strewn about it.
///
/// A further start multiplies each parameter by exp(s z), z standard normal, keeping its sign
/// (every fourth start draws the signs, too); a parameter that starts at 0 becomes s z. Where both
/// bounds are finite, every second start is uniform between them. Seed and options fix every start.
/// Among equal minima (a sum of like terms has them in any order) it takes the nearest to the given
/// start.
///
/// No proof of a global minimum: `n_agreeing` tells how often it was found. Of NIST's Statistical
/// Reference Datasets for nonlinear regression it finds all 27 certified minima from both starts,
/// each parameter to 6 digits, each standard uncertainty to 4 (Lanczos1, of residuals of 1e-13: 2).
///
/// @return None if the residuals exist at no start.
std::optional<MultiStartFit> fit_from_many_starts(const LeastSquaresProblem& problem,
                                                  const MultiStartOptions& options = {});

}  // namespace manoscope::numerics
