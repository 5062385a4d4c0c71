// The least that noise of pixels can do to p(x): the limit of Cramer and Rao.
#pragma once

#include "manoscope/core/arrays.hpp"
#include "manoscope/twin/scenario.hpp"

namespace manoscope::campaign {

/// Standard uncertainty of p(x) from the pixels of one flow map, no unbiased estimate has less.
///
/// For an exactly known wall, labels without error, and a p(x) that is a natural cubic spline
/// through knots half a millimetre apart, told by white noise sigma of every pixel on its own:
///
///   u^2(x) = b(x)^T F^-1 b(x),  F = int J^T J (n_z rho/(sigma^2 dx)) dx,  J = (d zeta/dp) B,
///
/// b and B the spline, d zeta/dp the wall's influence operator at the true p(x), n_z the pixels
/// across the wall, dx their pitch along it. rho(x) = <s^2>/<s>^2, with s(z) the wall's answer to a
/// uniform change of pressure: what pixels tell beyond their mean, 6/5 for a parabola. Missing
/// pixels are counted as lost.
///
/// Source: Cramer (1946); Kay, Fundamentals of Statistical Signal Processing (1993), ch. 3.
///
/// @param scenario  its wall is a plate, its camera's noise white.
/// @param nodes, pressure  (n) m, Pa: the true p(x).
/// @param x  (m) m.
/// @return (m) Pa.
Array1 pixel_limit(const twin::Scenario& scenario, const Array1& nodes, const Array1& pressure,
                   const Array1& x);

}  // namespace manoscope::campaign
