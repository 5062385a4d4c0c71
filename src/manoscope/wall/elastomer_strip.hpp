#pragma once

#include "manoscope/core/units.hpp"
#include "manoscope/wall/wall_section.hpp"

namespace manoscope::wall {

/// Small deflections of a long thick strip clamped along both edges: bending and shear.
///
///   crest = p a^4/(24 D) + p a^2/(2 kappa G t),   a = w/2, G = E/(2 (1 + nu))
///   shape = (b (1 - s^2)^2 + c (1 - s^2))/(b + c), b and c the two parts of the crest
///   mean over crest = (8/15 b + 2/3 c)/(b + c)
///
/// Source: Timoshenko's beam theory in plane strain, the sheared part held at the edges like the
/// bent one. c/b = 2 (t/a)^2/(kappa (1 - nu)): of a wall 605 um thick and 1.7 mm wide with nu =
/// 0.49 shear makes 70 % of the crest.
///
/// Validity: prestress and stretching are left out; the PlateStrip has both. They stiffen the wall
/// by at most 1.2 s0 (1 - nu^2)/E (a/t)^2/(1 - shear_share()) and 0.8 (crest/t)^2/(1 -
/// shear_share()) of its pressure. For t > w/2 a strip theory is itself off by several per cent at
/// the clamped edges.
class ElastomerStrip {
 public:
  /// @throws InputError if a property is out of range or shear_correction is 0.
  explicit ElastomerStrip(const WallSection& section);

  const WallSection& section() const { return section_; }
  /// Share of shear in the crest deflection, 0 to 1.
  double shear_share() const { return sheared_ / (bent_ + sheared_); }

  Pressure pressure(Length crest) const {
    return Pressure::from_si(crest.si() / (bent_ + sheared_));
  }
  Length crest(Pressure pressure) const {
    return Length::from_si(pressure.si() * (bent_ + sheared_));
  }
  double crest_compliance(Length) const { return bent_ + sheared_; }
  double shape(Length crest, double s) const;
  double mean_over_crest(Length crest) const;
  Length deflection(Pressure pressure) const { return mean_over_crest(Length{}) * crest(pressure); }

 private:
  WallSection section_;
  double bent_ = 0.0, sheared_ = 0.0;  ///< crest per pressure, m/Pa
};

}  // namespace manoscope::wall
