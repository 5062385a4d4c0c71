#pragma once

#include <memory>

#include "manoscope/core/monitor.hpp"
#include "manoscope/wall/fvk_model.hpp"

namespace manoscope::wall {

/// Options of solve_equilibrium().
struct NewtonOptions {
  /// Relative residual to reach. Round-off leaves about 1e-12 on grids with very thin layers.
  double tolerance = 1e-9;
  Index max_iterations = 60;
  /// Seek a minimum of the energy (a state that stands) rather than any equilibrium: steps go
  /// downhill only, and a saddle is left along its unstable direction.
  bool stable = true;
};

/// An equilibrium and the factored tangent there.
struct Equilibrium {
  Eigen::VectorXd q;
  double residual = 0.0;  ///< relative, at q
  Index iterations = 0;   ///< factorisations used
  bool converged = false;
  /// Of the Hessian at the last point it was made, within one Newton step of q.
  std::shared_ptr<const BlockFactorisation> tangent;
};

/// Relative residual of dU/dq = load: the norm of the imbalance over that of the moduli of all
/// parts it is made of, unknowns weighted by the diagonal stiffness of the flat wall.
class ResidualNorm {
 public:
  explicit ResidualNorm(const FvkModel& model);
  double operator()(const Eigen::VectorXd& imbalance, const Eigen::VectorXd& magnitude) const;
  /// Norm sqrt(sum d^2 K) of a step.
  double step(const Eigen::VectorXd& d) const;

 private:
  Eigen::ArrayXd stiffness_;
};

/// Newton's method with the exact tangent and an exact line search: along a line the energy is a
/// polynomial of degree four, whose first minimum is found from three slopes.
/// @param start  Any state; zero for the flat wall.
/// Does not throw where it does not converge: `converged` says so.
/// @throws Interrupted if the monitor says so; it is asked before every factorisation.
Equilibrium solve_equilibrium(const FvkModel& model, const ResidualNorm& norm,
                              const Eigen::VectorXd& load, const Eigen::VectorXd& start,
                              const NewtonOptions& options = {}, const Monitor& monitor = {});

/// Hessian of the flat wall without prestress: positive definite.
BlockTridiagonal flat_hessian(const FvkModel& model);

}  // namespace manoscope::wall
