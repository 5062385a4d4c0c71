#pragma once

#include <optional>

#include "manoscope/inversion/nonlocal_options.hpp"
#include "manoscope/inversion/nonlocal_wall.hpp"
#include "manoscope/inversion/read_pressure.hpp"

namespace manoscope::inversion {

/// A reading that takes the wall's neighbourhood into account.
struct NonlocalReading {
  PressureReading pressure;
  /// m: of a ripple of this wavelength, at mid-channel, the reading shows half.
  double half_wavelength = 0.0;
  double misfit = 0.0;  ///< chi-square of the stations against the smooth p(x), per station
  int iterations = 0;   ///< wall states solved
};

/// Reads p(x) as the pressure whose wall response gives the observed deflection.
///
/// A station-by-station reading r(x) of the deflection (read_pressure()) is R[p](x) of
/// WallResponse plus noise, both counted in the pressures of the model (NonlocalWall::offset). p is
/// a natural cubic spline through graded_nodes(), 9 % of the width apart at the ends, that
/// minimises
///
///   (r - R[p])^T V^-1 (r - R[p]) + weight int p''(x)^2 / s(x) dx,   V = diag(v) + E E^T,
///
/// by Gauss-Newton steps with the exact kernel dR/dp. The weight, and by how much p may bend more
/// sharply near the ends (s = 1 + V exp(-(d/z)^2), d the distance from the end, z half a width or a
/// third of the half-response wavelength, V from 0 to 1e6), are those that make the data most
/// likely (numerics::fit_penalised()), but never so small that ripples finer than `finest_ripple`
/// would be asked of a wall that hardly shows them. v_i is the station's own noise; the doubt of
/// interpolation, one error over all stations between two levels; and as noise of a correlation
/// length of 0.3 widths: model_error times the correction R - p, and half of what the offset
/// changes from level to level where the correction changes with pressure as such (at a buckling
/// front). The columns of E are what wrong places of the maps do (modes of the source
/// "registration"): a p(x) that bends as a shifted map would have it is less likely than the shift,
/// so that the fit finds the place, too, where the wall is steep.
///
/// Uncertainty: the spline's posterior, as error modes ("reading" for pixel noise, times the number
/// of neighbouring stations whose residuals go together; "smoothness" for the rest); where the
/// finest ripple is in force, what one finer by the square root of 2 would change; every mode of
/// the station-by-station reading carried through the same linear estimate; and model_error times
/// the correction, one variable for each half of the channel ("wall model").
///
/// Stations without an answer stay without. Stations nearer to an end than 8 % of the width do not
/// take part and have no answer (`insensitive`): the wall hardly rises there.
///
/// Source: our own. The kernel's reach is the wall's own (about w/pi under tension); see
/// docs/accuracy.md for errors on virtual experiments.
///
/// @param local  of the same stations as the curves of the calibration; without end doubt.
/// @return none where the steps do not come to rest, or too few stations have an answer: the local
/// reading stands then. A last step below half a standard uncertainty is accepted, and in the bars.
/// @throws InputError if an option is out of range; Interrupted.
std::optional<NonlocalReading> read_nonlocal(const PressureReading& local, const NonlocalWall& wall,
                                             double coverage,
                                             const ReadNonlocalOptions& options = {});

}  // namespace manoscope::inversion
