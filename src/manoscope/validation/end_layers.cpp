#include "manoscope/validation/end_layers.hpp"

#include <numbers>

namespace manoscope::validation {

Array1 knots_at(const Array1& positions) {
  const Index n = positions.size();
  Array1 knots(n + 2);
  knots << 2.0 * positions[0] - positions[1], positions, 2.0 * positions[n - 1] - positions[n - 2];
  return knots;
}

std::vector<Array1> end_bends(const Array1& x, Length width) {
  const double reach = width.si() / std::numbers::pi;
  const Array1 ends = ((x[0] - x) / reach).exp() + ((x - x[x.size() - 1]) / reach).exp();
  std::vector<Array1> bends;
  for (const double factor : {0.0, 10.0, 100.0, 1000.0}) bends.emplace_back(1.0 + factor * ends);
  return bends;
}

}  // namespace manoscope::validation
