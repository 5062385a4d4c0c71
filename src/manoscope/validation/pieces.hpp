#pragma once

#include "manoscope/core/arrays.hpp"
#include "manoscope/core/profile.hpp"
#include "manoscope/inversion/read_pressure.hpp"
#include "manoscope/inversion/test_section.hpp"

namespace manoscope::validation {

/// Whether a station holds a deflection and a pressure.
bool counts(const inversion::PressureReading& reading, const Profile& state, Index ix);

/// Weights of mean pressures over consecutive pieces of the test section, each less that of the
/// last piece.
///
/// A pressure that is known up to a constant has one number less than pieces. Means over a piece
/// keep what a whole run says (a slope to 1 - 1/n^2 of its information) and leave out what lies
/// between neighbouring stations, where a smoothed reading pretends to know more than it does.
///
/// @param n_pieces  at most; fewer where fewer stations count.
/// @return (pieces - 1, n_x).
/// @throws InputError if fewer than two stations of the section count.
Matrix piece_weights(const inversion::PressureReading& reading, const Profile& state,
                     const inversion::TestSection& section, Index n_pieces);

/// d^T V^-1 d with its degrees of freedom and the probability of a larger one.
struct ChiSquare {
  double value = 0.0;
  double dof = 0.0;
  double tail = 1.0;
  /// -(value + ln det V)/2, less a constant of dof: a model that is vague fits easily, and is told
  /// apart here.
  double log_likelihood = 0.0;
};

/// Chi-square of differences that should be 0.
///
/// @param floor  standard deviation added to every difference, independent: what no comparison
///               resolves; keeps V regular.
ChiSquare chi_square(const Array1& difference, const Matrix& covariance, double floor);

/// What no comparison of a model with a reading resolves, as a share of the drop: quadrature along
/// the stations and tables of sections.
inline constexpr double kResolution = 1e-4;

}  // namespace manoscope::validation
