#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "manoscope/calibration/constitutive_curves.hpp"
#include "manoscope/core/units.hpp"

namespace manoscope::inversion {

/// p = f(zeta) of a wall where it does not feel its ends: that of the stations two to three widths
/// from one of them, averaged; in a channel shorter than six widths, of those about its middle.
///
/// What a clamped end does to a wall falls as exp(-pi x/w) or faster: it is below 0.2 % from two
/// widths on, below 1 % in the shortest channel that is taken.
class FreeCurve {
 public:
  enum class End { inlet, outlet };
  /// Pressure f, Pa; its slope f' = a, Pa/m; what another fair interpolant would add to f, Pa.
  struct Point {
    double pressure, stiffness, doubt;
  };
  /// A knot of the curve: mean deflection, m, of some levels.
  struct Knot {
    double zeta;
    std::vector<Index> levels;
  };

  /// @return none where the channel is shorter than 4 widths, fewer than three knots count there,
  ///         or zeta does not rise with pressure throughout.
  static std::optional<FreeCurve> about(const calibration::ConstitutiveCurves& curves,
                                        Length length, Length width, End end);

  /// f(zeta); straight on beyond the outer knots by a tenth of the interval there, NaN farther out.
  Point at_deflection(double zeta) const;
  /// The deflection at a pressure, m, held to that of the outer knots.
  double deflection(double pressure) const;

  /// At least three, ascending.
  const std::vector<Knot>& knots() const { return knots_; }
  /// The knot below a deflection, and how far it lies to the next one, in [0, 1].
  std::pair<std::size_t, double> place(double zeta) const;
  /// The stations that were averaged.
  const std::vector<Index>& stations() const { return stations_; }

 private:
  void add_point(const calibration::ConstitutiveCurve& curve, double pressure);

  std::vector<Knot> knots_;
  std::vector<Index> stations_;
  std::vector<double> zeta_, pressure_, stiffness_, doubt_;  ///< of a fine table, ascending
};

}  // namespace manoscope::inversion
