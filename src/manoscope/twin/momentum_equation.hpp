#pragma once

#include "manoscope/core/arrays.hpp"
#include "manoscope/flow/channel.hpp"
#include "manoscope/flow/duct_resistance.hpp"

namespace manoscope::twin {

/// S^2 along a channel: the largest and where it is, m.
struct Choking {
  double square = 0.0, at = 0.0;
};

/// What stands for the section of a channel in its momentum balance.
struct Rectangle {
  flow::DuctFormula formula = flow::DuctFormula::series;  ///< of the side walls
  double momentum_factor = 1.2;                           ///< beta; 0 = creeping flow
};

/// The momentum balance of a rectangle of the mean gap, as p at the nodes of a ChannelCurve:
///
///   p(x) = p_out + int_x^l r Q dx' + (beta rho Q^2/2) (1/A(l)^2 - 1/A(x)^2),  A = w (2 h0 + zeta)
///
/// Integrals by cubics through four nodes, fourth order in the spacing.
class MomentumEquation {
 public:
  /// @param grading  of the n + 1 nodes, as in ChannelCurve.
  MomentumEquation(const flow::Channel& channel, const flow::Fluid& fluid,
                   const Rectangle& rectangle, Index n, double grading);

  const Array1& x() const { return x_; }  ///< the nodes, m

  /// What p should be where the wall stands at zeta: (n + 1) m -> (n + 1) Pa.
  Array1 pressure(double flow_rate, double outlet, const Array1& zeta) const;
  /// Its derivative: (n + 1, n + 1), Pa/m.
  Matrix slope(double flow_rate, const Array1& zeta) const;
  /// Largest S^2 = beta rho Q^2 (dA/dp)/A^3.
  /// @param compliance  (n + 1) d zeta/dp, m/Pa.
  Choking choking(double flow_rate, const Array1& zeta, const Array1& compliance) const;

 private:
  flow::Channel channel_;
  flow::Fluid fluid_;
  flow::DuctFormula formula_;
  Array1 x_;
  Matrix integral_;
  double flux_;  ///< beta rho, kg/m^3
};

}  // namespace manoscope::twin
