#pragma once

namespace manoscope::numerics {

/// Probability that chi-square of so many degrees of freedom, not necessarily whole, is larger.
/// @param dof  above 0.
double chi_square_tail(double chi_square, double dof);

/// Probability that the smallest of n independent p-values is at most `smallest` by chance:
/// 1 - (1 - p)^n (Sidak 1967).
double smallest_of(double smallest, double n);

}  // namespace manoscope::numerics
