#pragma once

#include <string>

#include "manoscope/core/arrays.hpp"
#include "manoscope/core/units.hpp"

namespace manoscope::wall {

/// Mean over the width of a parabola that is zero at both edges, in units of its crest: 2/3
/// (Ozsun, Yakhot & Ekinci 2013, eq. (3)).
inline constexpr double kParabolaMean = 2.0 / 3.0;

/// A thin wall clamped along its two long edges.
struct Membrane {
  Length width{};              ///< w, between the clamped edges
  Length thickness{};          ///< t
  Pressure youngs_modulus{};   ///< E
  double poisson_ratio = 0.0;  ///< nu, in (-1, 0.5]
  Pressure prestress{};        ///< s0, tension positive; must not be negative here

  /// @throws InputError at `where` naming the first property out of range.
  void validate(const std::string& where) const;
};

/// Bulge law of a long clamped membrane: pressure against crest deflection.
///
///   p = 2 s0 t z / a^2 + (4/3) E/(1 - nu^2) t z^3 / a^4,   a = w/2, z crest deflection
///
/// Source: the classical bulge-test relation of a long rectangular membrane (plane strain): tension
/// N = s0 t + E/(1 - nu^2) t (2/3)(z/a)^2, the strain of a parabola, balances p = 2 N z/a^2. It is
/// the law behind the p^(1/3) asymptote of fig. 1(f) in Ozsun, Yakhot & Ekinci (2013).
///
/// Validity: long (length >= 4 w and away from its ends), thin (bending left out: the clamped edge
/// layer sqrt(D/N) is much narrower than a), shallow (z <= 0.2 a: the parabola's arc is taken to
/// second order, an error of about 0.8 (z/a)^2 of the stretching term), linear elastic, not
/// compressed (s0 >= 0; a wall under compression buckles and is not described here). Odd in z: it
/// holds for a wall pressed inward too.
class LongMembrane {
 public:
  /// @throws InputError if a property is out of range.
  explicit LongMembrane(const Membrane& membrane);

  const Membrane& membrane() const { return membrane_; }

  /// Pressure that holds a crest deflection.
  Pressure pressure(Length crest) const { return Pressure::from_si(pressure_si(crest.si())); }
  /// Crest deflection under a pressure: the one real root of the cubic, exact to round-off.
  Length crest(Pressure pressure) const { return Length::from_si(crest_si(pressure.si())); }
  /// Width-averaged deflection under a pressure, kParabolaMean times the crest.
  Length deflection(Pressure pressure) const { return kParabolaMean * crest(pressure); }
  /// d(crest)/d(pressure) at a crest deflection, m/Pa. Infinite for s0 = 0 at zero deflection.
  double crest_compliance(Length crest) const;

  /// The same for many pressures: (n), Pa in; (n) crest deflections, m out.
  Array1 crest(const Array1& pressure) const;

 private:
  double pressure_si(double z) const { return (linear_ + cubic_ * z * z) * z; }
  double crest_si(double p) const;

  Membrane membrane_;
  double linear_ = 0.0;  ///< 2 s0 t / a^2, Pa/m
  double cubic_ = 0.0;   ///< (4/3) E/(1 - nu^2) t / a^4, Pa/m^3
};

}  // namespace manoscope::wall
