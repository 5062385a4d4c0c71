#pragma once

#include "manoscope/core/units.hpp"
#include "manoscope/wall/cubic_law.hpp"
#include "manoscope/wall/wall_section.hpp"

namespace manoscope::wall {

/// Clamped square plate under a small load, `section.width` its side w.
///
///   crest = 0.00126531909 p w^4/D;  shape along the centre line s = 2 z/w: (1 - s^2)^2 times an
///   even polynomial, mean along it 0.55333177
///
/// Source: our Ritz solution in Legendre polynomials times (1 - x^2)^2 (1 - z^2)^2, all digits
/// given stand still from 8 x 8 to 16 x 16 terms; Timoshenko & Woinowsky-Krieger (art. 44, table
/// 35) print 0.00126. The polynomial meets that solution within 6e-7 of the crest.
///
/// Validity: thin (shear left out), no prestress, crest below 0.2 t: stretching takes about 0.52
/// (crest/t)^2 off the crest.
class SquarePlate {
 public:
  /// @throws InputError if a property is out of range.
  explicit SquarePlate(const WallSection& section);

  const WallSection& section() const { return section_; }
  Pressure pressure(Length crest) const { return Pressure::from_si(crest.si() / compliance_); }
  Length crest(Pressure pressure) const { return Length::from_si(pressure.si() * compliance_); }
  double crest_compliance(Length) const { return compliance_; }
  double shape(Length crest, double s) const;
  double mean_over_crest(Length) const { return 0.55333177; }
  /// Mean along the centre line.
  Length deflection(Pressure pressure) const { return mean_over_crest(Length{}) * crest(pressure); }

 private:
  WallSection section_;
  double compliance_;
};

/// Bulge law of a square membrane, `section.width` its side 2a.
///
///   p = 3.39344932 s0 t z/a^2 + (2.037 - 0.588 nu)/(1 - nu) E t z^3/a^4
///
/// Source: the linear constant and the shape are the series solution of the tensioned square
/// (Poisson's equation); the cubic constant is the thin limit of the FopplVonKarman wall for 0 <=
/// nu <= 0.5, to 0.1 %.
///
/// Validity: no bending (edge layer sqrt(D/N) much narrower than a), shallow (z <= 0.2 a), no
/// compression, nu >= 0. Where prestress and stretching meet the sum is off by up to 2 % of the
/// pressure. The shape is that of prestress alone; a slack membrane's mean along the centre line is
/// 0.2 % higher.
class SquareMembrane {
 public:
  /// @throws InputError if a property is out of range or the prestress negative.
  explicit SquareMembrane(const WallSection& section);

  const WallSection& section() const { return section_; }
  Pressure pressure(Length crest) const { return Pressure::from_si(law_.pressure(crest.si())); }
  Length crest(Pressure pressure) const { return Length::from_si(law_.crest(pressure.si())); }
  double crest_compliance(Length crest) const { return law_.compliance(crest.si()); }
  double shape(Length crest, double s) const;
  double mean_over_crest(Length) const { return 0.6866175; }
  /// Mean along the centre line.
  Length deflection(Pressure pressure) const { return mean_over_crest(Length{}) * crest(pressure); }

 private:
  WallSection section_;
  CubicLaw law_;
};

}  // namespace manoscope::wall
