#include "manoscope/numerics/chi_square.hpp"

#include <boost/math/special_functions/gamma.hpp>
#include <cmath>

#include "manoscope/core/error.hpp"

namespace manoscope::numerics {

double chi_square_tail(double chi_square, double dof) {
  MANO_ASSERT(dof > 0.0);
  // Further out the tail underflows; nobody asks how often that happens.
  constexpr double kFar = 1000.0;
  if (chi_square > dof + kFar + 40.0 * std::sqrt(dof)) return 0.0;
  return boost::math::gamma_q(0.5 * dof, 0.5 * chi_square);
}

double smallest_of(double smallest, double n) {
  return smallest >= 1.0 ? 1.0 : -std::expm1(n * std::log1p(-smallest));
}

}  // namespace manoscope::numerics
