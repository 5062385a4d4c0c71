#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "manoscope/calibration/constitutive_curves.hpp"
#include "manoscope/inversion/curvature_fit.hpp"
#include "manoscope/inversion/free_curve.hpp"
#include "manoscope/inversion/read_pressure.hpp"
#include "manoscope/inversion/weak_window.hpp"

namespace manoscope::inversion {

/// One end of the wall: where it is asked, and its curve where it does not feel that end.
struct EndZone {
  FreeCurve curve;
  std::vector<std::vector<WeakWindow>> windows;  ///< of each level, on the stations it has
};

/// Writes p_k - f(zeta) = b zeta'' for the windows of both ends, with the effects of every error.
///
/// The first n_shared() errors are the same variables at every level; those behind belong to the
/// level alone.
class RestRows {
 public:
  RestRows(const calibration::ConstitutiveCurves& curves, const std::vector<EndZone>& zones,
           const GaugeErrors& gauge);

  Index n_shared() const { return n_shared_; }
  /// Windows whose deflections f does not cover are left out.
  CurvatureRows rows(Index level) const;

 private:
  /// What one window leans on.
  struct Window {
    double target = 0.0;    ///< Pa
    Eigen::VectorXd own;    ///< (n_stations of it) Pa/m, mean weight times stiffness
    Eigen::VectorXd label;  ///< (n_levels) share of each level's pressure in mean f
    Eigen::VectorXd shift;  ///< (n_levels) Pa/m, what a shift of a level far from the end does
    Eigen::VectorXd doubt;  ///< (n_knots - 1) Pa
  };
  /// By zone, then by window.
  std::vector<bool> smooth_windows(Index level) const;
  std::optional<Window> ask(const EndZone& zone, const WeakWindow& window, Index level) const;
  void add_effects(std::size_t zone, const WeakWindow& window, const Window& asked, Index level,
                   Index row, CurvatureRows& rows) const;

  const calibration::ConstitutiveCurves& curves_;
  const std::vector<EndZone>& zones_;
  Matrix labels_;                                   ///< (n_levels, n) Pa
  std::map<std::string, Index> column_;             ///< of the variables of the profiles
  std::vector<Index> noise_column_, doubt_column_;  ///< first one of each zone
  Index n_shared_ = 0;
  /// Far from each end, by zone and level: effects on the mean deflection, m, by column.
  std::vector<std::vector<std::vector<std::pair<Index, double>>>> far_;
};

}  // namespace manoscope::inversion
