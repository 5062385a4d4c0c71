#pragma once

#include <vector>

#include "manoscope/core/arrays.hpp"
#include "manoscope/numerics/natural_spline.hpp"
#include "manoscope/numerics/penalised_fit.hpp"

namespace manoscope::numerics {

/// Values with independent errors of known size.
struct NoisyValues {
  Array1 x;      ///< (n)
  Array1 y;      ///< (n)
  Array1 sigma;  ///< (n) standard deviations, > 0
  /// (n) y is the mean of the curve over this length about x; empty: its value there.
  Array1 window = {};
};

/// A smooth curve through noisy values: as rough as they make likely, and no rougher.
///
/// Minimises  sum ((y_i - g(x_i))/sigma_i)^2 + weight int (g''/c)^2 dx  over natural cubic splines
/// on given knots. c says how much more the curve may bend in one place than in another; it and the
/// weight are those that make the data most likely (fit_penalised()), so that the errors' size is
/// used and no more is taken away than they explain. Source: Green & Silverman, Nonparametric
/// Regression and Generalized Linear Models (1994), ch. 2; Wahba, Spline Models for Observational
/// Data (1990), ch. 4.
///
/// The curve is linear in y once weight and c are chosen. Where c = 1 and the data lie evenly, a
/// ripple of wave number k keeps the share 1/(1 + (k/k_half)^4).
///
/// Accuracy: on smooth curves the standard uncertainty covers the error on average over x (tests).
class SmoothingSpline {
 public:
  /// @param knots          (k) ascending, k >= 4; the curve has no second derivative at the outer
  ///                       two: let them lie beyond the data where it may bend to its ends.
  /// @param bends          candidates for c at the inner knots, (k - 2) each, > 0; at least one.
  /// @param finest_ripple  half_wavelength() is not made smaller.
  SmoothingSpline(NoisyValues data, const Array1& knots, const std::vector<Array1>& bends,
                  double finest_ripple);

  /// (m) g at positions between the outer knots.
  Array1 value(const Array1& x) const;
  /// (m, n) g there from the data: value = weights y.
  Matrix weights(const Array1& x) const;
  /// (m) standard uncertainty of g, errors of the data and what smoothing may hide.
  Array1 standard(const Array1& x) const;

  /// Wavelength of a ripple of which half is left, where c = 1.
  double half_wavelength() const { return half_wavelength_; }
  /// Which of the candidates was taken.
  std::size_t bend() const { return fit_.penalty; }
  /// sum ((y_i - g(x_i))/sigma_i)^2
  double misfit() const { return fit_.misfit; }

 private:
  Matrix sampling(const Array1& x) const { return spline_.sampling(x) * to_values_; }

  NoisyValues data_;
  NaturalSpline spline_;
  Matrix to_values_;  ///< of the coefficients, at the knots
  Matrix model_;      ///< (n, k) values at the data from coefficients
  PenalisedFit fit_;
  double half_wavelength_ = 0.0;
};

}  // namespace manoscope::numerics
