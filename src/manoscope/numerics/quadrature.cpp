#include "manoscope/numerics/quadrature.hpp"

#include "manoscope/core/error.hpp"

namespace manoscope::numerics {

Array1 trapezoid_weights(const Array1& x) {
  MANO_ASSERT(x.size() >= 1);
  Array1 weights = Array1::Zero(x.size());
  for (Index i = 1; i < x.size(); ++i) {
    const double half = 0.5 * (x[i] - x[i - 1]);
    weights[i - 1] += half;
    weights[i] += half;
  }
  return weights;
}

}  // namespace manoscope::numerics
