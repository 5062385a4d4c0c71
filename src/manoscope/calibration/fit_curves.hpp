#pragma once

#include <vector>

#include "manoscope/calibration/constitutive_curves.hpp"
#include "manoscope/calibration/joint_labels.hpp"

namespace manoscope::calibration {

struct FitCurvesOptions {
  double pooling = 2.0;            ///< in standard uncertainties of the difference of two labels
  double fold_significance = 3.0;  ///< in standard uncertainties of the fall of zeta
  bool joint_labels = true;        ///< estimate the pressures of the levels together

  template <class Visitor>
  void describe(Visitor&& visit) {
    visit("pooling", pooling,
          "pool levels closer than this many standard uncertainties of their difference");
    visit("fold-significance", fold_significance,
          "a fall of zeta with pressure counts as real from this many standard uncertainties on");
    visit("joint-labels", joint_labels,
          "let all pressure labels together tell each level's pressure, by a smooth wall law");
  }
  /// @throws InputError naming the option out of range.
  void validate() const;
};

/// Constitutive curves zeta(p) through calibration levels, station by station.
///
/// The curves go through the pressures of estimate_labels() unless the options say otherwise or
/// the labels do not allow it.
///
/// Levels whose pressures cannot be told apart (closer than `pooling` standard uncertainties of
/// their difference, both uncertain) form one knot, the mean of both: noise on the labels then
/// neither swaps levels nor makes steep steps. At each station a stretch where zeta falls with
/// pressure is pooled too if the fall is within `fold_significance` standard uncertainties, and
/// kept as a fold if it is real: a buckled wall, whose readings there are ambiguous.
///
/// @param levels  in any order; repeats of one pressure are averaged.
/// @param wall    of a model fitted to an earlier fit of these levels, for their labels alone.
/// @throws InputError as sort_levels().
ConstitutiveCurves fit_curves(std::vector<Level> levels, const FitCurvesOptions& options = {},
                              const WallCurves* wall = nullptr);

/// The curves that fit_curves() is expected to find once the labels of these levels are read: for
/// planning. Pressures are those of expect_labels(), or the true ones where it has none.
///
/// @param levels  with their true pressures and profiles without errors; the uncertainties are
/// those
///                that labels and profiles will have. Several levels at one pressure are readings
///                to come: they stay levels of their own, and pool into one knot.
/// @throws InputError as sort_levels().
ConstitutiveCurves expect_curves(std::vector<Level> levels, const FitCurvesOptions& options = {});

}  // namespace manoscope::calibration
