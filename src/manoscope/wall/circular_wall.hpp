#pragma once

#include "manoscope/core/units.hpp"
#include "manoscope/wall/cubic_law.hpp"
#include "manoscope/wall/wall_section.hpp"

namespace manoscope::wall {

/// Clamped circular plate under a small load, `section.width` its diameter 2a.
///
///   crest = p a^4/(64 D),  shape (1 - s^2)^2, s = r/a;  mean along a diameter 8/15, over the area
///   1/3
///
/// Source: Timoshenko & Woinowsky-Krieger, Theory of Plates and Shells, art. 16.
///
/// Validity: thin (shear left out), no prestress, crest below 0.2 t: stretching takes
/// (173 + 100 nu - 73 nu^2)/360 (crest/t)^2 off the crest, 0.546 (crest/t)^2 at nu = 0.3. That is
/// the second order of the Foeppl-von Karman equations of the disc with a held edge, polynomials in
/// s throughout (our own expansion); Ritz solutions with the shape kept at (1 - s^2)^2 give less.
class CircularPlate {
 public:
  /// @throws InputError if a property is out of range.
  explicit CircularPlate(const WallSection& section);

  const WallSection& section() const { return section_; }
  Pressure pressure(Length crest) const { return Pressure::from_si(crest.si() / compliance_); }
  Length crest(Pressure pressure) const { return Length::from_si(pressure.si() * compliance_); }
  double crest_compliance(Length) const { return compliance_; }
  double shape(Length crest, double s) const;
  double mean_over_crest(Length) const { return 8.0 / 15.0; }
  /// Mean along a diameter.
  Length deflection(Pressure pressure) const { return mean_over_crest(Length{}) * crest(pressure); }

 private:
  WallSection section_;
  double compliance_;
};

/// Bulge law of a circular membrane, `section.width` its diameter 2a.
///
///   p = 4 s0 t z/a^2 + K(nu) E t z^3/a^4
///
/// K(nu) is Hencky's (1915) exact coefficient of a slack membrane, from his power series: 3.6 at
/// nu = 0.3. (The spherical cap's 8/3/(1 - nu) would be 6 % higher there.)
///
/// Validity: no bending (edge layer sqrt(D/N) much narrower than a), shallow (z <= 0.2 a), no
/// compression. Exact where prestress or stretching is alone; where they meet the sum is off by up
/// to 2 % of the pressure (nu >= 0). The shape is the parabola of prestress alone, mean along a
/// diameter 2/3; a slack membrane is fuller, its mean higher by 2 % (nu = 0.5) to 3.3 % (nu = 0).
class CircularMembrane {
 public:
  /// @throws InputError if a property is out of range or the prestress negative.
  explicit CircularMembrane(const WallSection& section);

  /// K(nu) of a slack membrane, nu in (-1, 0.5].
  static double hencky_coefficient(double poisson_ratio);

  const WallSection& section() const { return section_; }
  Pressure pressure(Length crest) const { return Pressure::from_si(law_.pressure(crest.si())); }
  Length crest(Pressure pressure) const { return Length::from_si(law_.crest(pressure.si())); }
  double crest_compliance(Length crest) const { return law_.compliance(crest.si()); }
  double shape(Length crest, double s) const;
  double mean_over_crest(Length) const { return 2.0 / 3.0; }
  /// Mean along a diameter.
  Length deflection(Pressure pressure) const { return mean_over_crest(Length{}) * crest(pressure); }

 private:
  WallSection section_;
  CubicLaw law_;
};

}  // namespace manoscope::wall
