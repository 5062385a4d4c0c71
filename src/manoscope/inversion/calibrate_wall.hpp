#pragma once

#include <optional>
#include <string>

#include "manoscope/calibration/constitutive_curves.hpp"
#include "manoscope/core/units.hpp"
#include "manoscope/wall/clamped_wall.hpp"

namespace manoscope::inversion {

/// What is known of a wall before its calibration is looked at.
struct WallKnowledge {
  Length length{}, width{}, thickness{};
  std::optional<double> poisson_ratio;  ///< else 0.49 of a soft wall (E < 0.1 GPa), 0.25 of others
};

/// A clamped wall that answers to uniform pressure as the calibration found.
struct CalibratedWall {
  wall::ClampedWall wall;
  /// Relative standard uncertainty of what the wall makes of a pressure that is not uniform: three
  /// times the relative misfit of its profiles near the ends, at least 1 %. (An end layer whose
  /// length is off by a share s moves the profile there by at most s/e.)
  double model_error = 0.0;
};

/// Fits a clamped Foeppl-von Karman wall to a calibration.
///
/// At mid-channel a long wall is a strip: E, prestress and preload are those of the strip's law
/// (wall::fit_law) through the deflections there; the preload's lopsidedness is what its values at
/// a quarter and three quarters of the length differ by. Walls thicker than 2 % of their width are
/// taken to shear (kappa = 5/6). Only the answer to *differences* of pressure along x will be taken
/// from this wall, so it need not meet the calibration better than the model_error says.
///
/// @return none where no such wall comes near the calibration, with the reason in words.
std::optional<CalibratedWall> calibrate_wall(const calibration::ConstitutiveCurves& curves,
                                             const WallKnowledge& known, std::string& reason);

/// Relative misfit, near the ends, of model profiles against those of the calibration: root mean
/// square over 0.1 to 1 width from either end of the ratio model/measured over its median at
/// mid-channel, minus 1. Levels count whose deflection at mid-channel is above 30 % of the largest.
///
/// @param model  (n_levels, n_x) m, at the levels and stations of the curves.
/// @return 1 where no level counts.
double end_misfit(const calibration::ConstitutiveCurves& curves, const Array2& model, Length length,
                  Length width);

}  // namespace manoscope::inversion
