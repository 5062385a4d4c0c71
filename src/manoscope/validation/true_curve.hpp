#pragma once

#include <optional>
#include <vector>

namespace manoscope::validation {

/// The true constitutive curve of one station, from what truth tells of its levels: pressure,
/// deflection and compliance.
///
/// Between neighbouring levels p is the cubic in zeta that has both pressures and both slopes
/// dp/dzeta = 1/compliance (Hermite). For a wall law with p cubic in zeta, such as a long membrane
///
///   p = a zeta + b zeta^3,
///
/// it is that law to round-off, whatever the levels; for any other smooth law the error is of
/// fourth order in the steps between levels, h^4 p''''/384 at most. It knows nothing of what may
/// happen between two levels: a snap-through there that leaves zeta rising from one to the other is
/// bridged if the cubic can rise through it.
class TrueCurve {
 public:
  struct Node {
    double pressure;    ///< Pa
    double deflection;  ///< m
    double compliance;  ///< d zeta / d p, m/Pa
  };
  /// @param nodes  in any order; of several at one pressure the first counts.
  explicit TrueCurve(std::vector<Node> nodes);

  /// The one pressure, Pa, at which the wall stands at this deflection, m.
  ///
  /// @return nullopt outside the levels, where a stretch of falling deflection between two levels
  ///         makes more than one pressure possible, and between levels that no rising cubic joins
  ///         (a compliance that is not positive, or a snap-through).
  std::optional<double> pressure(double deflection) const;

 private:
  std::vector<Node> nodes_;
};

}  // namespace manoscope::validation
