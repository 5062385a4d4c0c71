#pragma once

#include "manoscope/core/arrays.hpp"
#include "manoscope/core/units.hpp"
#include "manoscope/wall/cubic_law.hpp"
#include "manoscope/wall/wall_section.hpp"

namespace manoscope::wall {

/// Mean over the width of a parabola that is zero at both edges, in units of its crest: 2/3
/// (Ozsun, Yakhot & Ekinci 2013, eq. (3)).
inline constexpr double kParabolaMean = 2.0 / 3.0;

/// A thin wall clamped along its two long edges; its prestress must not be negative.
using Membrane = WallSection;

/// Bulge law of a long clamped membrane: pressure against crest deflection.
///
///   p = 2 s0 t z / a^2 + (4/3) E/(1 - nu^2) t z^3 / a^4,   a = w/2, z crest deflection
///
/// Source: the classical bulge-test relation of a long rectangular membrane (plane strain): tension
/// N = s0 t + E/(1 - nu^2) t (2/3)(z/a)^2, the strain of a parabola, balances p = 2 N z/a^2. It is
/// the law behind the p^(1/3) asymptote of fig. 1(f) in Ozsun, Yakhot & Ekinci (2013).
///
/// Validity: long (length >= 4 w and away from its ends), thin (bending left out: the clamped edge
/// layer d = sqrt(D/N) is much narrower than a; the law's pressure is low by 1.5 d/a to 2 d/a),
/// shallow (z <= 0.2 a: the parabola's arc is taken to second order, an error of about 0.8 (z/a)^2
/// of the stretching term), linear elastic, not compressed (s0 >= 0; a wall under compression is
/// the PlateStrip's). Odd in z: it holds for a wall pressed inward too.
class LongMembrane {
 public:
  /// @throws InputError if a property is out of range.
  explicit LongMembrane(const Membrane& membrane);

  const Membrane& membrane() const { return membrane_; }
  const WallSection& section() const { return membrane_; }

  /// Pressure that holds a crest deflection.
  Pressure pressure(Length crest) const { return Pressure::from_si(law_.pressure(crest.si())); }
  /// Crest deflection under a pressure: the one real root of the cubic, exact to round-off.
  Length crest(Pressure pressure) const { return Length::from_si(law_.crest(pressure.si())); }
  /// Width-averaged deflection under a pressure, kParabolaMean times the crest.
  Length deflection(Pressure pressure) const { return kParabolaMean * crest(pressure); }
  /// d(crest)/d(pressure) at a crest deflection, m/Pa. Infinite for s0 = 0 at zero deflection.
  double crest_compliance(Length crest) const { return law_.compliance(crest.si()); }
  /// The parabola 1 - s^2, whatever the crest; s = 2 z/w.
  double shape(Length crest, double s) const;
  double mean_over_crest(Length) const { return kParabolaMean; }

  /// The same for many pressures: (n), Pa in; (n) crest deflections, m out.
  Array1 crest(const Array1& pressure) const;

 private:
  Membrane membrane_;
  CubicLaw law_;  ///< 2 s0 t / a^2 and (4/3) E/(1 - nu^2) t / a^4
};

}  // namespace manoscope::wall
