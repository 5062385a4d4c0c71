#pragma once

#include <memory>
#include <vector>

#include "manoscope/calibration/shape_survey.hpp"
#include "manoscope/core/arrays.hpp"

namespace manoscope::calibration {

/// How well the wall's cross-sections in one map are those that pressure gives it.
///
/// Arrays have shape (n_x) of the stretches, `residual` (n_z, n_x). NaN where there is no verdict:
/// no shape to compare with, too few good cells.
struct ShapeMisfit {
  Array1 chi_square, dof;  ///< of the cells of a stretch; see StretchMisfit
  Array2 residual;         ///< m, deflection minus the calibrated shape
  /// Pa: by how much a reading by the width average may be off if the misfit is no pressure. The
  /// larger of what moved the average if the deformation is of few bins (moved_average()) and of
  /// the misfit's root mean square beyond the noise; 0 where chi_square is no larger than chance
  /// makes it once in a thousand stretches.
  Array1 reading_shift;
};

/// Is it pressure that bends this wall? The shapes of hydrostatic maps, and how others compare.
///
/// Under uniform pressure the cross-section zeta(z) at x depends on one number, the pressure, and
/// so on its own width average alone: the shape of that average is interpolated between the levels
/// (shape_nodes()), stretch by stretch, and compared with the map's (stretch_misfit()). Dust, a
/// particle, heat, a fault of the bond or another channel show as chi-square beyond its degrees of
/// freedom.
///
/// Under flow, neighbours bend the shape too: a wall under tension by about (w/pi)^2 zeta'' times a
/// shape of mean 0 that is even and smooth across. Allowed for is a tenth of (w/pi)^2 times the
/// difference of zeta'' to that of the levels, over two stretches to either side (clamped walls of
/// the kind of the paper's S1, S4 and S5: 0.02 to 0.05); how far the interpolants of three and four
/// levels lie apart; and what a shift along the flow does.
///
/// A level's map that has a fault of its own would blame all others: a stretch of one that does not
/// fit between its neighbours, by more than chance does once in 10^6, is left out, of those
/// involved the one without which the other levels agree best.
///
/// Source: our own. False alarms at their stated rate inside the test section (tests of `pipeline`
/// on virtual experiments); within a width of the clamped ends more often.
class CalibratedShapes {
 public:
  /// @param levels  hydrostatic maps in order of their pressure.
  /// @param width   of the channel, m.
  CalibratedShapes(const std::vector<ShapedMap>& levels, double width);
  ~CalibratedShapes();
  CalibratedShapes(CalibratedShapes&&) noexcept;
  CalibratedShapes& operator=(CalibratedShapes&&) noexcept;

  /// A map that is none of the levels.
  ShapeMisfit misfit(const ShapedMap& map) const;
  /// A level's map against the shapes of the others.
  ShapeMisfit misfit_of_level(Index level) const;

 private:
  struct Maps;
  std::unique_ptr<Maps> maps_;
};

}  // namespace manoscope::calibration
