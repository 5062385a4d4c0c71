#include "manoscope/twin/channel_curve.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "manoscope/core/error.hpp"

namespace manoscope::twin {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;

}  // namespace

ChannelCurve::ChannelCurve(Length length, Array1 values, double grading)
    : length_(length.si()), grading_(grading), values_(std::move(values)) {
  MANO_ASSERT(values_.size() >= 4 && length_ > 0.0 && grading_ >= 0.0 && grading_ < 1.0);
}

Array1 ChannelCurve::nodes(Length length, Index n, double grading) {
  const Array1 s = Array1::LinSpaced(n + 1, 0.0, 1.0);
  Array1 x = length.si() * (s - grading / kTurn * (kTurn * s).sin());
  x(n) = length.si();  // the sine of a whole turn is not quite 0
  return x;
}

Array1 ChannelCurve::stretch(Length length, Index n, double grading) {
  const Array1 s = Array1::LinSpaced(n + 1, 0.0, 1.0);
  return length.si() * (1.0 - grading * (kTurn * s).cos());
}

double ChannelCurve::parameter(double x) const {
  const double share = x / length_;
  if (grading_ == 0.0) return share;
  // Newton's method within a bracket: the map rises everywhere, its slope is small at the ends.
  double low = 0.0, high = 1.0, s = share;
  for (int n = 0; n < 60; ++n) {
    const double miss = s - grading_ / kTurn * std::sin(kTurn * s) - share;
    (miss < 0.0 ? low : high) = s;
    double next = s - miss / (1.0 - grading_ * std::cos(kTurn * s));
    if (!(next >= low && next <= high)) next = 0.5 * (low + high);
    if (std::abs(next - s) <= 1e-15) return next;
    s = next;
  }
  return s;
}

double ChannelCurve::operator()(double x) const {
  if (!(x >= 0.0 && x <= length_)) return 0.0;
  const double position = parameter(x) * static_cast<double>(values_.size() - 1);
  const Index first =
      std::clamp<Index>(static_cast<Index>(std::floor(position)) - 1, 0, values_.size() - 4);
  const double u = position - static_cast<double>(first);  // the four nodes stand at 0, 1, 2, 3
  const double a = u - 1.0, b = u - 2.0, c = u - 3.0;
  return -a * b * c / 6.0 * values_(first) + u * b * c / 2.0 * values_(first + 1) -
         u * a * c / 2.0 * values_(first + 2) + u * a * b / 6.0 * values_(first + 3);
}

Array1 ChannelCurve::operator()(const Array1& x) const {
  return x.unaryExpr([this](double at) { return (*this)(at); });
}

}  // namespace manoscope::twin
