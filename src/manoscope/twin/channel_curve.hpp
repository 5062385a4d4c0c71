#pragma once

#include "manoscope/core/arrays.hpp"
#include "manoscope/core/units.hpp"

namespace manoscope::twin {

/// A smooth function of x on [0, length], known at nodes that may stand closer at both ends, where
/// a clamped wall and the pressure under it change fastest:
///
///   x = length (s - grading sin(2 pi s)/(2 pi)),  s = 0, 1/n, ..., 1.
///
/// The spacing at the ends is 1 - grading times the mean one. Between nodes it is the cubic in s
/// through the four nearest (Lagrange), one-sided at the ends: the error is of fourth order in the
/// spacing. Outside [0, length] it is 0, as a deflection is on the rim.
class ChannelCurve {
 public:
  /// @param values  (n + 1), n >= 3, at nodes(length, n, grading).
  /// @param grading  in [0, 1); 0 = evenly spaced.
  /// @throws InternalError if there are fewer, the length is not positive or the grading is out of
  ///         range.
  ChannelCurve(Length length, Array1 values, double grading = 0.0);

  /// The n + 1 nodes, m.
  static Array1 nodes(Length length, Index n, double grading = 0.0);
  /// dx/ds at the nodes, m.
  static Array1 stretch(Length length, Index n, double grading = 0.0);

  double operator()(double x) const;
  /// (n), m -> (n).
  Array1 operator()(const Array1& x) const;

  Length length() const { return Length::from_si(length_); }
  const Array1& values() const { return values_; }
  /// Its own nodes, m.
  Array1 x() const { return nodes(length(), values_.size() - 1, grading_); }

 private:
  /// s of a position in [0, length].
  double parameter(double x) const;

  double length_, grading_;
  Array1 values_;
};

}  // namespace manoscope::twin
