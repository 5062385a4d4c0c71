#pragma once

#include <memory>
#include <vector>

#include "manoscope/core/monitor.hpp"
#include "manoscope/wall/clamped_wall.hpp"

namespace manoscope::wall {

class FopplVonKarman;

/// Grid and accuracy of a FopplVonKarman wall.
struct FopplVonKarmanOptions {
  Index n_cells_x = 40;  ///< along the flow; even, at least 4
  Index n_cells_z = 14;  ///< over half the width; even, at least 2
  /// The grid resolves the clamped edge layer sqrt(D/N) that the wall has at this pressure.
  Pressure design_pressure = 10.0 * kPa;
  /// Model one half: shapes and loads are even in z. False admits any p(x, z), at ten times the
  /// cost.
  bool symmetric = true;
  double tolerance = 1e-9;  ///< relative residual of an equilibrium
  int max_iterations = 80;  ///< factorisations of one Newton solution

  /// @throws InputError naming the first option out of range.
  void validate() const;
};

/// One equilibrium of a wall. Positions in m, deflections in m from the plane of the rim.
class WallState {
 public:
  /// zeta(x, z); zero outside the wall.
  double deflection(double x, double z) const;
  /// (1/w) int zeta dz at stations: (n) -> (n).
  Array1 average_deflection(const Array1& x) const;
  double average_deflection(double x) const;
  /// In-plane displacement along x and along z at a point, m.
  double displacement_x(double x, double z) const;
  double displacement_z(double x, double z) const;
  /// Energy of the wall itself, J (bending, shear, stretching, prestress; without the loads).
  double elastic_energy() const;
  /// Volume under the deflected wall, m^3.
  double volume() const;

  double residual() const { return residual_; }     ///< relative
  Index iterations() const { return iterations_; }  ///< factorisations of the full grid
  /// Number of directions in which the wall would leave this state by itself; 0 = it stands.
  Index n_unstable() const { return n_unstable_; }
  const Eigen::VectorXd& unknowns() const { return q_; }  ///< scaled

 private:
  friend class FopplVonKarman;
  struct Grid;
  std::shared_ptr<const Grid> grid_;
  Eigen::VectorXd q_;
  double residual_ = 0.0;
  Index iterations_ = 0, n_unstable_ = 0;
};

/// Static deflection of a clamped rectangular wall: Foeppl-von Karman plate with bending,
/// stretching, prestress of either sign, an initial shape or preload, and shear flexibility.
///
///   D lap^2 (zeta - zeta0) - div(N grad zeta) = p - P,   div N = 0,
///   N = s0 t I + E t/(1 - nu^2) ((1 - nu) e + nu tr(e) I),
///   e = sym grad(u) + (grad zeta grad zeta - grad zeta0 grad zeta0)/2,
///   zeta = 0, grad zeta = 0, u = 0 at the edges (sliding edges: only the part of u across them).
///
/// With a shear correction kappa the deflection is zeta = b + s, s sheared by kappa G t grad s and
/// held at the edges, b bent and clamped: for a strip this is Timoshenko's theory, and adds
/// p a^2/(2 kappa G t) to the crest.
///
/// Source: Foeppl (1907), von Karman (1910); Marguerre (1938) for the initial shape. Solved by
/// Bogner-Fox-Schmit (bicubic Hermite) elements on a graded grid and Newton's method with the
/// exact tangent. The deflection converges with the fourth power of the cell size.
///
/// Validity: shallow (zeta <= 0.2 a, at most kLargestRise a), linear elastic, pressure normal to
/// the plane (not following the wall's slope).
///
/// Same bytes for the same input: everything runs on the calling thread.
class FopplVonKarman {
 public:
  /// @param monitor  asked before every factorisation of every solution: a solution that is to
  ///                 stop throws Interrupted.
  /// @throws InputError if a property or option is out of range.
  explicit FopplVonKarman(const ClampedWall& wall, const FopplVonKarmanOptions& options = {},
                          Monitor monitor = {});

  const ClampedWall& wall() const { return wall_; }
  const FopplVonKarmanOptions& options() const { return options_; }
  const Monitor& monitor() const { return monitor_; }

  /// The wall at its initial shape; not an equilibrium unless nothing acts on it.
  WallState unloaded() const;
  /// The state that the wall reaches from its initial shape, first on a grid of half the cells.
  /// It stands (is a minimum of the energy).
  /// @throws InputError if no equilibrium is found, or the load is not even in z where it must be.
  WallState equilibrium(const WallLoad& load) const;
  /// The state that the wall reaches from another by going downhill in energy.
  WallState equilibrium(const WallLoad& load, const WallState& start) const;
  /// The equilibrium that plain Newton steps reach from a start, standing or not; null where they
  /// reach none. For following branches.
  std::unique_ptr<WallState> nearby_equilibrium(const WallLoad& load, const WallState& start) const;
  /// start + step * rate: a state predicted along a branch.
  WallState predicted(const WallState& start, double step, const Eigen::VectorXd& rate) const;
  /// d(unknowns)/d(share) at an equilibrium when a share of a load comes on top of the present one.
  Eigen::VectorXd rate(const WallState& state, const WallLoad& load) const;
  /// Work of a load on the way from the plane of the rim to a state, int p zeta dx dz, J.
  double work(const WallState& state, const WallLoad& load) const;

  /// Influence operator d zeta_avg(x_i) / d p(x_j), m/Pa, at an equilibrium: (n, n).
  ///
  /// The pressure is the piecewise linear function through the stations, constant beyond the
  /// first and last: row sums are the answer to a uniform change of pressure. Divide column j by
  /// the station's weight (trapezoid rule) for the kernel per length of x'. Exact linearisation of
  /// the discrete wall; one factorisation serves all stations.
  /// @param stations  (n) m, strictly ascending.
  /// @throws InputError if the stations are empty, unsorted or not finite.
  Matrix influence(const WallState& state, const Array1& stations) const;

  /// Prestress (negative) at which the flat wall first buckles; without preload or initial shape.
  Pressure critical_prestress() const;

 private:
  Eigen::VectorXd scaled_load(const WallState::Grid& grid, const WallLoad& load) const;
  Eigen::VectorXd scaled_pressure(const WallLoad& load) const;  ///< the preload left out
  WallState state_at(const std::shared_ptr<const WallState::Grid>& grid) const;

  ClampedWall wall_;
  FopplVonKarmanOptions options_;
  Monitor monitor_;
  std::shared_ptr<const WallState::Grid> coarse_, fine_;
};

}  // namespace manoscope::wall
