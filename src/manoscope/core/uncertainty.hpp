#pragma once

#include <string>
#include <vector>

#include "manoscope/core/arrays.hpp"

namespace manoscope {

/// Coverage factor of every expanded uncertainty U = k u that is shown or judged: about 95 % for
/// normal errors, and what the E_n number of ISO/IEC 17043 takes.
inline constexpr double kExpansion = 2.0;

/// One error variable shared by many stations: what one standard deviation of it does to each.
///
/// `variable` names the physical error ("level plane of h03.gsf, tilt x", "gauge zero"). The same
/// name in two places is the same error: that is how correlations between stations, between
/// profiles, and between a reading and the flow model are known. Different names are independent.
struct ErrorMode {
  std::string variable;
  std::string source;  ///< budget line it belongs to: "leveling", "pressure labels", ...
  Array1 effect;       ///< (n), in the unit of the value, per standard deviation
};

/// Uncertainty of n values: a part independent from station to station, and shared error modes.
///
///   covariance = diag(independent^2) + sum_j effect_j effect_j^T
///
/// Standard uncertainties (k = 1), GUM (JCGM 100:2008) and JCGM 102:2011 for the vector form.
struct Uncertainty {
  Array1 independent;  ///< (n) standard uncertainty, independent between stations
  std::vector<ErrorMode> modes;

  /// (n) combined standard uncertainty.
  Array1 standard() const;
  /// (n, n) full covariance.
  Matrix covariance() const;
  /// Covariance of two weighted sums, sum a_i v_i and sum b_i v_i, of the same values.
  double covariance(const Array1& a, const Array1& b) const;
};

/// One scalar with its uncertainty by error variable; the scalar sibling of Uncertainty.
struct Estimate {
  struct Term {
    std::string variable;
    std::string source;
    double effect;  ///< signed, per standard deviation of the variable; NaN: not known
  };
  double value = 0.0;
  std::vector<Term> terms;

  /// NaN if an effect is not known.
  double standard_uncertainty() const;
};

/// Covariance of two estimates: the terms whose variables carry the same name.
double covariance(const Estimate& a, const Estimate& b);

}  // namespace manoscope
