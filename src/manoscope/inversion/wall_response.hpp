#pragma once

#include <vector>

#include "manoscope/calibration/constitutive_curves.hpp"
#include "manoscope/core/arrays.hpp"
#include "manoscope/core/monitor.hpp"
#include "manoscope/core/units.hpp"
#include "manoscope/wall/continuation.hpp"
#include "manoscope/wall/foppl_von_karman.hpp"

namespace manoscope::inversion {

/// Positions along a wall from 0 to its length, both included: some share of the width apart within
/// 0.7 widths of the ends, 12 % inside, with a smooth passage between; symmetric.
/// @param at_ends  that share, in (0, 0.12].
Array1 graded_nodes(Length length, Length width, double at_ends);
/// Positions at which a wall's answer to p(x) is told: 3.5 % of the width apart near both ends,
/// where it is stiff.
Array1 response_nodes(Length length, Length width);

/// Wavelength, m, of a ripple of p(x) of which the wall at a node shows half. 0 if it shows more of
/// every ripple longer than two cells, or less of every one.
///
/// @param nodes   (n) m, of response_nodes().
/// @param answer  (n) of the wall at the node to the pressure at each node, in any unit.
double half_response_wavelength(const Array1& nodes, const Eigen::VectorXd& answer, Index node);

/// What reading a wall station by station makes of a pressure that is not uniform.
///
/// A station-by-station reading looks up the deflection zeta(x) on the curve zeta(x; p) of the wall
/// under *uniform* pressure. Under p(x) the wall deflects otherwise, since it feels its
/// neighbourhood, so the reading R(x) is not p(x): inside it is p smoothed over the wall's reach,
/// near a clamped end it is biased towards the inside. R and its derivative K = dR(x)/dp(x') are
/// computed from the same wall model both times: errors of the model that change curve and
/// deflection alike cancel. The model's curves run through its states at the levels as those of a
/// calibration do (calibration::ConstitutiveCurve), so that R also holds what such a curve misses
/// where the wall turns sharply between two levels.
class WallResponse {
 public:
  /// Solves the wall at uniform pressures, ascending, at least 3, Pa: of the calibration's levels.
  ///
  /// @throws InputError where the wall has no single rising curve (it snaps), or no equilibrium is
  ///         found; Interrupted if the monitor says so.
  WallResponse(const wall::ClampedWall& wall, const Array1& levels, const Monitor& monitor);

  const Array1& nodes() const { return nodes_; }  ///< (n) m
  /// Width-averaged deflection at the levels: (n_levels, n_x), m.
  Array2 profiles(const Array1& x) const;

  /// Reading of a pressure, and its derivative.
  struct Answer {
    Eigen::VectorXd reading;  ///< (n) Pa at the nodes; at the two ends, p itself
    Matrix kernel;            ///< (n, n) dR_i / dp_j; rows sum to 1 where the curve is true
  };
  /// @param pressure  (n) Pa at the nodes, linear in between.
  /// @throws InputError if the wall has no equilibrium near that of a uniform pressure.
  Answer answer(const Eigen::VectorXd& pressure) const;

  /// half_response_wavelength() of a reading, about a node; of the kernel's row there.
  double half_wavelength(const Matrix& kernel, Index node) const;

 private:
  wall::FopplVonKarman wall_;
  Array1 nodes_, levels_;
  std::vector<wall::WallState> states_;
  Array2 deflection_, compliance_;                      ///< (n_levels, n) at the nodes
  std::vector<calibration::ConstitutiveCurve> curves_;  ///< of the nodes between the ends

  /// Pressure at which the wall's own curve has this deflection at a node, and dp/dzeta there.
  struct Inverse {
    double pressure, slope;
  };
  Inverse invert(Index node, double deflection) const;
};

}  // namespace manoscope::inversion
