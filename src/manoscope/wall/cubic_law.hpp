#pragma once

namespace manoscope::wall {

/// p = linear z + cubic z^3, both coefficients >= 0 and not both 0: the common form of bulge laws.
struct CubicLaw {
  double linear = 0.0;  ///< Pa/m
  double cubic = 0.0;   ///< Pa/m^3

  double pressure(double z) const { return (linear + cubic * z * z) * z; }
  /// The one real root of pressure(z) = p, exact to round-off.
  double crest(double p) const;
  /// dz/dp at a crest z, m/Pa; infinite for linear = 0 at z = 0.
  double compliance(double z) const;
};

}  // namespace manoscope::wall
