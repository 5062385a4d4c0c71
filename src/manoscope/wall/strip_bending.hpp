#pragma once

namespace manoscope::wall {

/// Clamped strip under tension and uniform load, in scaled form.
///
/// With s = z/a in [-1, 1] and u^2 = q = N a^2/D the bending of the strip obeys
/// W'''' - q W'' = 1, W = W' = 0 at the edges; deflection = (p a^4/D) W. Then, C(q) = (u coth u -
/// 1)/q,
///
///   crest    f = W(0)              = (1/2 - tanh(u/2)/u)/q,
///   average  g = int_0^1 W ds      = (1/3 - C)/q,
///   stretch  h = int_0^1 W'^2/2 ds = -g'(q)/2,
///
/// the last because q is the force that works on the stretch. For q < 0 (compression) the
/// hyperbolic functions become circular ones; all have a pole at q = -pi^2, the buckling load of
/// the clamped strip, below which its crest lies against the load (f < 0), and the next at -4 pi^2.
/// At q = 0: f = 1/24, g = 1/45, h = 1/945.
///
/// Source: Timoshenko & Woinowsky-Krieger, Theory of Plates and Shells, ch. 1 (bending to a
/// cylindrical surface, built-in edges; their u is u here); g and h follow by integration.
struct StripBending {
  double f, f_slope;  ///< crest, d/dq
  double g;           ///< average; dg/dq = -2 h
  double h, h_slope;  ///< stretch, d/dq

  /// Relative accuracy 5e-12 for -9.8 <= q <= 1e12 and between the poles, -39 <= q <= -10.
  /// @param q  > -4 pi^2, not -pi^2.
  static StripBending at(double q);
};

/// W(s) of the strip; 0 beyond its edges.
double strip_shape(double q, double s);

}  // namespace manoscope::wall
