#pragma once

#include "manoscope/core/units.hpp"

namespace manoscope::flow {

/// Pressure that creeping flow loses on one side of a rectangular hole in a thin plate, between
/// the hole and a half-space without bound.
///
///   3 sqrt(pi) eta Q E(k) / (w h^2),  k^2 = 1 - h^2/w^2, h the shorter side
///
/// E is the complete elliptic integral of the second kind.
///
/// Source: half of the drop through an elliptical aperture of semi-axes a >= b,
/// 3 eta Q E(k)/(pi a b^2), R. Roscoe, Phil. Mag. 40 (1949) 338, with the ellipse that has area and
/// proportions of the rectangle: a = w/sqrt(pi), b = h/sqrt(pi). Limits: half of Sampson's 3 eta
/// Q/a^3 of a round hole (1891) for a = b; along a long ellipse the slit, 16 eta (Q/w)/(pi h^2) a
/// half, H. Hasimoto, J. Phys. Soc. Japan 13 (1958) 633.
/// Error: within 5.5 % of the rectangle itself for all proportions, low by 5 % for a square and
/// high by 4.4 % for a long slit; 0.5 % for a gap/width of 0.1.
///
/// @throws InputError if a side or the viscosity is not positive.
Pressure aperture_loss(Viscosity eta, FlowRate flow_rate, Length width, Length height);

}  // namespace manoscope::flow
