#pragma once

#include <optional>

#include "manoscope/core/arrays.hpp"
#include "manoscope/wall/bulge.hpp"

namespace manoscope::wall {

/// What holds a wall down before any fluid pressure acts: the load that its clamping leaves in it.
struct Preload {
  Pressure load{};            ///< inward (towards the fluid) load at mid-length
  double lopsidedness = 0.0;  ///< relative difference of the load between outlet and inlet end
};

/// A long membrane whose two ends are held: the simplest wall with a length.
///
///   zeta(x; p) = T(x) (2/3) z(p - P(x))
///   T(x) = (1 - e^(-x/L)) (1 - e^(-(l - x)/L)),   P(x) = load (1 + lopsidedness (x/l - 1/2))
///
/// with z(p) of LongMembrane and L the influence length of the wall along x, by default w/pi, that
/// of a wall under isotropic tension: zeta - L^2 zeta'' = c p has the end layers e^(-x/L).
///
/// Source: our own composition, meant for virtual experiments: the mid-length law is the bulge law,
/// the end layers are those of a linear tensioned strip. Not a solution of the plate equations: the
/// wall answers to the pressure at x alone. The preload stands for the clamping that leaves the
/// wall of the paper's S1 bowed towards the fluid at p = 0.
class TaperedMembrane {
 public:
  /// @param length  l, the wall reaches from x = 0 to x = l.
  /// @param influence_length  L; by default w/pi.
  /// @throws InputError if a size or property is out of range (lopsidedness in [-2, 2]).
  TaperedMembrane(Length length, const Membrane& membrane, const Preload& preload = {},
                  std::optional<Length> influence_length = std::nullopt);

  Length length() const { return Length::from_si(length_); }
  Length influence_length() const { return Length::from_si(influence_length_); }
  const LongMembrane& cross_section() const { return section_; }
  const Preload& preload() const { return preload_; }

  /// Width-averaged deflection at x in [0, l], 0 outside; x in m, gauge pressure in Pa, zeta in m.
  double deflection(double x, double pressure) const;
  /// d zeta/dp there, m/Pa; x in m, gauge pressure in Pa.
  double compliance(double x, double pressure) const;
  /// Deflections at many stations, one pressure each: (n), (n) -> (n).
  Array1 deflection(const Array1& x, const Array1& pressure) const;
  /// The same at many stations under one uniform pressure.
  Array1 deflection(const Array1& x, Pressure pressure) const;

 private:
  /// T(x), 0 outside.
  double taper(double x) const;
  /// Crest deflection without the taper, m.
  Length crest(double x, double pressure) const;

  double length_, influence_length_;
  LongMembrane section_;
  Preload preload_;
};

}  // namespace manoscope::wall
