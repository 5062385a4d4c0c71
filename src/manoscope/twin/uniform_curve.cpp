#include "manoscope/twin/uniform_curve.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "manoscope/core/error.hpp"

namespace manoscope::twin {

UniformCurve::UniformCurve(Length length, Array1 values)
    : length_(length.si()), values_(std::move(values)) {
  MANO_ASSERT(values_.size() >= 4 && length_ > 0.0);
}

double UniformCurve::operator()(double x) const {
  if (!(x >= 0.0 && x <= length_)) return 0.0;
  const double position = x / length_ * static_cast<double>(values_.size() - 1);
  const Index first =
      std::clamp<Index>(static_cast<Index>(std::floor(position)) - 1, 0, values_.size() - 4);
  const double u = position - static_cast<double>(first);  // the four nodes stand at 0, 1, 2, 3
  const double a = u - 1.0, b = u - 2.0, c = u - 3.0;
  return -a * b * c / 6.0 * values_(first) + u * b * c / 2.0 * values_(first + 1) -
         u * a * c / 2.0 * values_(first + 2) + u * a * b / 6.0 * values_(first + 3);
}

Array1 UniformCurve::operator()(const Array1& x) const {
  return x.unaryExpr([this](double at) { return (*this)(at); });
}

}  // namespace manoscope::twin
