#pragma once

#include "manoscope/core/arrays.hpp"
#include "manoscope/core/units.hpp"

namespace manoscope::twin {

/// A smooth function of x on [0, length], known at evenly spaced nodes.
///
/// Between nodes it is the cubic through the four nearest (Lagrange), one-sided at the ends: the
/// error is of fourth order in the spacing. Outside [0, length] it is 0, as a deflection is on the
/// rim.
class UniformCurve {
 public:
  /// @param values  (n), n >= 4, at x = 0, length/(n - 1), ..., length.
  /// @throws InternalError if there are fewer, or the length is not positive.
  UniformCurve(Length length, Array1 values);

  double operator()(double x) const;
  /// (n), m -> (n).
  Array1 operator()(const Array1& x) const;

  Length length() const { return Length::from_si(length_); }
  const Array1& values() const { return values_; }

 private:
  double length_;
  Array1 values_;
};

}  // namespace manoscope::twin
