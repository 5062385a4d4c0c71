#pragma once

#include <string>
#include <vector>

#include "manoscope/core/uncertainty.hpp"

namespace manoscope::report {

/// A unit to show numbers in, and its size in SI.
struct DisplayUnit {
  double si = 1.0;
  std::string name;
};

/// The unit in which a quantity of that size is read most easily: the largest one that does not
/// exceed `largest`, else the smallest. `largest` is a magnitude in SI; NaN counts as 0.
DisplayUnit pressure_unit(double largest);   ///< Pa, kPa, MPa
DisplayUnit length_unit(double largest);     ///< nm, µm, mm, m
DisplayUnit flow_rate_unit(double largest);  ///< nL/min, µL/min, mL/min, L/min

/// The number with that many significant digits, without exponent between 1e-4 and 1e7; "–" for a
/// number that does not exist, and a real minus sign.
std::string number_text(double value, int digits);

/// The number with that many digits behind the point (of a negative count, rounded before it), a
/// real minus sign and no minus zero; "–" for a number that does not exist.
std::string fixed_text(double value, int decimals);

/// A share in percent with its sign, to a tenth of a percent, to a hundredth where it is small:
/// "+0.2 %", "−0.03 %".
std::string signed_percent_text(double fraction);

/// The number with at most that many significant digits and no zeros behind the point: 70, 5.5.
std::string short_number_text(double value, int digits = 4);

/// "14.23 ± 0.12": the uncertainty with two significant digits, the value to the same decimal.
///
/// An uncertainty that does not exist or is 0 leaves the value alone with four digits; a value that
/// does not exist gives "–".
std::string number_text_with_uncertainty(double value, double uncertainty);

/// A fraction as percent with two significant digits, "< 0.01 %" for less.
std::string percent_text(double fraction);

}  // namespace manoscope::report
