#pragma once

#include <vector>

#include "manoscope/calibration/constitutive_curves.hpp"

namespace manoscope::calibration {

struct FitCurvesOptions {
  double pooling = 2.0;            ///< in standard uncertainties of the difference of two labels
  double fold_significance = 3.0;  ///< in standard uncertainties of the fall of zeta

  template <class Visitor>
  void describe(Visitor&& visit) {
    visit("pooling", pooling,
          "pool levels closer than this many standard uncertainties of their difference");
    visit("fold-significance", fold_significance,
          "a fall of zeta with pressure counts as real from this many standard uncertainties on");
  }
  /// @throws InputError naming the option out of range.
  void validate() const;
};

/// Constitutive curves zeta(p) through calibration levels, station by station.
///
/// Levels whose labels cannot be told apart (closer than `pooling` standard uncertainties of their
/// difference, both uncertain) form one knot, the mean of both: noise on the labels then neither
/// swaps levels nor makes steep steps. At each station a stretch where zeta falls with pressure is
/// pooled too if the fall is within `fold_significance` standard uncertainties, and kept as a fold
/// if it is real: a buckled wall, whose readings there are ambiguous.
///
/// @param levels  in any order; repeats of one pressure are averaged.
/// @throws InputError as sort_levels().
ConstitutiveCurves fit_curves(std::vector<Level> levels, const FitCurvesOptions& options = {});

}  // namespace manoscope::calibration
