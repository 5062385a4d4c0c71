#pragma once

#include <memory>
#include <optional>
#include <string>

#include "manoscope/calibration/joint_labels.hpp"
#include "manoscope/core/monitor.hpp"
#include "manoscope/inversion/calibrate_wall.hpp"
#include "manoscope/inversion/nonlocal_options.hpp"
#include "manoscope/inversion/wall_response.hpp"

namespace manoscope::inversion {

/// The wall model that non-local readings of one calibration share.
struct NonlocalWall {
  CalibratedWall calibrated;
  std::shared_ptr<const WallResponse> response;
  double half_wavelength = 0.0;  ///< m, at mid-channel under the middle level
  /// The model under uniform pressure: at the levels, those that agree within 2e-4 of the range
  /// counted once, and at the stations of the calibration.
  calibration::WallCurves uniform;
  /// (as uniform.pressure) Pa: the model under p - offset deflects as the wall did under p; median
  /// over the stations farther than half a width from the ends.
  Array1 offset;
};

/// Fits a wall to the calibration and solves it at the levels.
///
/// @return none where there is no such wall, with the reason in words.
/// @throws Interrupted if the monitor says so.
std::optional<NonlocalWall> make_nonlocal_wall(const calibration::ConstitutiveCurves& curves,
                                               const WallKnowledge& known,
                                               const ReadNonlocalOptions& options,
                                               const Monitor& monitor, std::string& reason);

/// Forms the offset anew for curves whose levels have other pressures than those that the wall
/// was fitted to.
void update_offset(NonlocalWall& wall, const calibration::ConstitutiveCurves& curves);

}  // namespace manoscope::inversion
