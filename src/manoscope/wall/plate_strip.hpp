#pragma once

#include "manoscope/core/units.hpp"
#include "manoscope/wall/wall_section.hpp"

namespace manoscope::wall {

/// A long strip clamped along both edges: the exact law from bending to membrane, of a wall under
/// tension or compression, thin or shear-flexible (cylindrical bending with stretching).
///
///   D W'''' - N W'' = p,  N = s0 t + E/(1 - nu^2) t (1/2a) int_0^a W'^2 dz,  W = W' = 0 at +-a
///
/// With n = N a^2/D, e = D/(kappa G t a^2) (0 for a wall rigid in shear), r = 1/(1 + e n),
/// q = r n, P = p a^4/(D t) and f, g, h of StripBending:
///
///   crest/t   = P (r^2 f(q) + r e/2),
///   average/t = P (r^2 g(q) + r e/3),
///   n = 12 s0 a^2/(E/(1 - nu^2) t^2) + 12 P^2 r^2 (r^2 h(q) + r e g(q) + e^2/6),
///
/// the last a scalar equation with one root. Small loads: crest p w^4/(384 D) + p a^2/(2 kappa G
/// t), shape (1 - (z/a)^2)^2 with average 8/15; large: LongMembrane's parabola with average 2/3.
///
/// Source: Timoshenko & Woinowsky-Krieger, Theory of Plates and Shells, ch. 1 (built-in edges);
/// prestress and shear (Timoshenko's strip) are carried through the same steps here: the sheared
/// part of the deflection is (D/kappa G t)(W''(a) - W''(z)) of the bent part.
///
/// Validity: long (length >= 4 w and away from its ends), shallow (crest <= 0.2 a: 0.8 (z/a)^2 of
/// the stretching term), linear elastic, flat at rest. Compression down to the buckling prestress;
/// at or below it a flat wall has two branches and no law of one value.
class PlateStrip {
 public:
  /// @throws InputError if a property is out of range, or the prestress buckles the wall.
  explicit PlateStrip(const WallSection& section);

  const WallSection& section() const { return section_; }
  /// -4 pi^2 D/(w^2 t), less in magnitude by 1 + pi^2 e for a wall that shears (Engesser).
  static Pressure buckling_prestress(const WallSection& section);

  Pressure pressure(Length crest) const;
  Length crest(Pressure pressure) const;
  double crest_compliance(Length crest) const;
  double shape(Length crest, double s) const;
  double mean_over_crest(Length crest) const;
  /// Width-averaged deflection.
  Length deflection(Pressure pressure) const;
  /// d(width-averaged deflection)/d(pressure) at a pressure, m/Pa.
  double deflection_compliance(Pressure pressure) const;
  /// In-plane tension N at mid-channel under a pressure, N/m.
  double tension(Pressure pressure) const;

 private:
  struct Answer {
    double crest, average, stretch;     ///< per load; the last per load squared
    double crest_slope, stretch_slope;  ///< by the tension; d(average) = -2 stretch
  };
  Answer answer(double tension) const;
  double tension_under(double load) const;
  double tension_at(double crest) const;

  WallSection section_;
  double rest_ = 0.0;   ///< n of the prestress alone
  double shear_ = 0.0;  ///< e
  double load_ = 0.0;   ///< D t/a^4, Pa
};

}  // namespace manoscope::wall
