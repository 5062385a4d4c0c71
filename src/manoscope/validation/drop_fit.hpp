#pragma once

#include <vector>

#include "manoscope/core/units.hpp"
#include "manoscope/validation/pieces.hpp"

namespace manoscope::validation {

/// A pressure drop at one flow rate.
struct DropPoint {
  FlowRate flow_rate{};
  Pressure drop{};
  Pressure uncertainty{};  ///< standard, of this point alone; 0 = not known
};

/// dp = a Q + b Q^2.
struct QuadraticFit {
  double linear = 0.0;     ///< a, Pa s/m3: friction
  double quadratic = 0.0;  ///< b, Pa s2/m6: inertia where positive, a wall that gives way where
                           ///< negative
  double linear_uncertainty = 0.0, quadratic_uncertainty = 0.0;
  ChiSquare fit;  ///< dof = points - 2; tail 1 without uncertainties
};

/// dp = C Q^n, a straight line in log-log.
struct PowerFit {
  double exponent = 1.0, exponent_uncertainty = 0.0;
  double at_unit = 0.0;  ///< C, Pa at 1 m3/s
  ChiSquare fit;
};

/// Fits to dp_t(Q) (fig. 2(a) of Ozsun, Yakhot & Ekinci (2013), where channels whose wall yields
/// bend down from the straight line of a rigid one).
///
/// Weighted least squares in closed form; for the power law the logarithms, weights dp/u. Where the
/// uncertainty of a point is not known every point counts by its own size, 1/|dp| (alike if one is
/// 0), so that a small drop is met as well as a large one, and the uncertainties of the parameters
/// come from the scatter of the points. An error that all
/// points share (gap, viscosity, pump) scales a, b and C alike and is not in them; n does not feel
/// it.
/// @throws InputError for fewer than two flow rates, or for a flow rate that is not positive; the
///         power law also for a drop that is not positive.
QuadraticFit fit_quadratic(const std::vector<DropPoint>& points);
PowerFit fit_power(const std::vector<DropPoint>& points);

}  // namespace manoscope::validation
