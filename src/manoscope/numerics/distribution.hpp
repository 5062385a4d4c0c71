#pragma once

#include "manoscope/core/random.hpp"

namespace manoscope::numerics {

/// What is known of one input quantity: its probability distribution, after table 1 of JCGM
/// 101:2008.
///
/// Made by the named functions below; every number in the unit of the quantity.
class Distribution {
 public:
  static Distribution normal(double mean, double sigma);
  /// Rectangular on [low, high] (6.4.2).
  static Distribution rectangular(double low, double high);
  /// Rectangular with limits known to +- `doubt` only: "curvilinear trapezoid" (6.4.3).
  static Distribution doubtful_rectangular(double low, double high, double doubt);
  /// Symmetric trapezoid (6.4.4); `top` is the ratio of the widths at the top and at the base.
  static Distribution trapezoidal(double low, double high, double top);
  /// Symmetric triangle (6.4.5).
  static Distribution triangular(double low, double high);
  /// U-shaped, of a quantity that cycles sinusoidally between two limits (6.4.6).
  static Distribution arcsine(double low, double high);
  /// Scaled and shifted t (6.4.9): the mean of observations, `scale` being s/sqrt(n).
  static Distribution student_t(double location, double scale, double degrees_of_freedom);
  /// Exponential on [0, inf): a quantity not below 0 whose estimate is `mean` (6.4.10).
  static Distribution exponential(double mean);
  /// Gamma with density x^(shape - 1) exp(-x/scale): counted objects (6.4.11).
  static Distribution gamma(double shape, double scale);

  /// Expectation; of a t with 1 degree of freedom or fewer, its location.
  double mean() const;
  /// Standard deviation; infinite for a t with 2 degrees of freedom or fewer.
  double sigma() const;
  /// One value of it.
  double draw(RandomStream& random) const;

 private:
  enum class Kind {
    normal,
    rectangular,
    doubtful_rectangular,
    trapezoidal,
    arcsine,
    student_t,
    exponential,
    gamma
  };
  Distribution(Kind kind, double a, double b, double c = 0.0) : kind_(kind), a_(a), b_(b), c_(c) {}

  Kind kind_;
  double a_, b_, c_;  // the arguments of the function that made it, in their order
};

}  // namespace manoscope::numerics
