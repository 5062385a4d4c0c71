#pragma once

#include <optional>
#include <string>
#include <vector>

#include "manoscope/calibration/constitutive_curves.hpp"
#include "manoscope/core/units.hpp"
#include "manoscope/flow/channel.hpp"
#include "manoscope/inversion/read_pressure.hpp"

namespace manoscope::inversion {

/// The tube law about one state of the wall: p = f(zeta) + b zeta'', f' = a.
struct TubeLaw {
  double deflection = 0.0;   ///< m, far from the ends: where a and b belong
  double stiffness = 0.0;    ///< a, Pa/m
  double b = 0.0;            ///< N/m; negative under tension
  double uncertainty = 0.0;  ///< of b, standard, misfit included
  double misfit = 0.0;       ///< N/m, by how much b differs from place to place; see CurvatureFit

  /// Distance of b from 0 in standard uncertainties.
  double significance() const;
  /// sqrt(-b/a), m, over which the wall forgets a disturbance; NaN where b is not negative.
  double healing_length() const;
};

/// A number with its standard uncertainty.
struct KnownNumber {
  double value = 0.0, uncertainty = 0.0;
};

/// What the ends of the wall tell of the law at uniform pressure.
struct TubeLawAtRest {
  std::vector<std::optional<TubeLaw>> levels;  ///< one a level; none where it does not show
  /// b of small deflections, N/m: b0 of b = b0 + b2 zeta^2 through all levels.
  std::optional<KnownNumber> small;
  /// m, from the end: the nearest place at which the law is asked for.
  double start = 0.0;
  std::string reason;  ///< why no level has one; empty if any has
};

/// b from the ends of the wall in the calibration, level by level.
///
/// At uniform pressure a uniform wall is straight but for its clamped ends. There
///
///   p_k - f(zeta(x; p_k)) = b_k zeta''(x; p_k),
///
/// f the wall's own curve far from the end (FreeCurve). It is asked in windows (WeakWindow) of a
/// quarter of the width, from where the wall is curved most (nearer to the edge a clamped plate is
/// curved the other way, and no law of second order holds) to 0.6 widths farther in, at both ends;
/// b_k by fit_curvature().
///
/// Source: Ozsun et al. 2013, eq. (5), with f(zeta) for its a zeta, which holds for small
/// deflections only.
///
/// Assumes that the wall is the same along x, its ends included: a wall that is merely stiffer near
/// its ends looks alike. And at deflections that stretch the wall, b of this law is not the axial
/// tension: on Foeppl-von Karman walls it is within 10 % the tension *across*, since tension
/// near an end is that of its neighbourhood, not that of the deflection there.
///
/// Uncertainty: pixels, planes and places of the maps, labels, gauge, interpolation; 0.3 % of b for
/// f between noisy labels; and the misfit.
///
/// @param curves  of stations along a channel.
TubeLawAtRest tube_law_at_rest(const calibration::ConstitutiveCurves& curves, Length length,
                               Length width, const GaugeErrors& gauge = {});

/// What a flow run tells of the law.
struct TubeLawUnderFlow {
  std::optional<TubeLaw> law;
  /// Gradient of pressure over that of the measured gap by Poiseuille's law (flow::DuctFormula).
  double resistance_factor = 0.0;
  std::string reason;  ///< why there is none; empty if there is one
};

/// b from what a flow run makes of the wall, whatever its ends are like.
///
/// Let r(x) be the station-by-station reading, p(x) the pressure. Station by station the curve
/// at uniform pressure holds f (any f, another at every x) and its own curvature, so that
///
///   r - p = -b (zeta'' - zeta_c''),
///
/// zeta under flow, zeta_c under the uniform pressure r(x), both at x: f cancels. p(x) follows
/// from the momentum balance of the measured gap h = 2 h0 + zeta,
///
///   p = p0 - int kappa r_h Q dx - beta rho Q^2/(2 A^2) - (rho Q^2/(2 A^2)) e K(x),
///   kappa = k0 + k1 (x/l - 1/2)
///
/// with r_h of a rectangular duct (exact series), A = w h, and K the excess drop of a flow that
/// starts to develop at the inlet (Shah & London 1978, between parallel plates). p0 and k0 are
/// free; of the others is assumed what flows in such channels have: beta = 1.2 +- 0.1,
/// k1 = 0 +- 0.1, e = 0 +- 0.5. All are fitted together with b by fit_curvature() in windows of a
/// quarter of the width, dense near both ends, from `start` on.
///
/// Source: our own. Needs nothing of the wall but that b is one number about the run's deflections:
/// it is the axial tension of a stretched wall. Does not hold the uncertainty of the gap in the
/// shape of r_h.
///
/// @param local  station-by-station reading of the run, without end doubt.
/// @param start  m, as TubeLawAtRest tells; 0 for an eighth of the width.
TubeLawUnderFlow tube_law_under_flow(const calibration::ConstitutiveCurves& curves,
                                     const Profile& state, const PressureReading& local,
                                     const flow::Channel& channel, const flow::Fluid& fluid,
                                     FlowRate flow_rate, double start);

}  // namespace manoscope::inversion
