#include "manoscope/wall/cubic_law.hpp"

#include <cmath>
#include <limits>

namespace manoscope::wall {

double CubicLaw::crest(double p) const {
  if (p == 0.0) return 0.0;
  if (cubic == 0.0) return p / linear;
  // cubic z^3 + linear z = p. With z = 2 s sinh(u), s = sqrt(linear / (3 cubic)), the identity
  // 4 sinh^3 u + 3 sinh u = sinh 3u leaves sinh 3u = p / (2 cubic s^3).
  const double s = std::sqrt(linear / (3.0 * cubic));
  const double unit = 2.0 * cubic * s * s * s;
  double z = std::abs(p) < 1e12 * unit ? 2.0 * s * std::sinh(std::asinh(p / unit) / 3.0)
                                       : std::cbrt(p / cubic);
  // One Newton step takes out the round-off of the hyperbolic functions.
  z -= (pressure(z) - p) / (linear + 3.0 * cubic * z * z);
  return z;
}

double CubicLaw::compliance(double z) const {
  const double stiffness = linear + 3.0 * cubic * z * z;
  return stiffness > 0.0 ? 1.0 / stiffness : std::numeric_limits<double>::infinity();
}

}  // namespace manoscope::wall
