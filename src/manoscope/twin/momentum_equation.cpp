#include "manoscope/twin/momentum_equation.hpp"

#include "manoscope/twin/channel_curve.hpp"

namespace manoscope::twin {
namespace {

/// Integral over s from each of n + 1 even nodes in [0, 1] to the last, as a matrix on the nodal
/// values: cubics through four nodes, fourth order.
Matrix integral_to_end(Index n) {
  const double step = 1.0 / static_cast<double>(n);
  Matrix integral = Matrix::Zero(n + 1, n + 1);
  for (Index i = n - 1; i >= 0; --i) {
    integral.row(i) = integral.row(i + 1);
    const auto add = [&](Index j, double weight) { integral(i, j) += step / 24.0 * weight; };
    if (i == 0) {
      add(0, 9.0), add(1, 19.0), add(2, -5.0), add(3, 1.0);
    } else if (i == n - 1) {
      add(n, 9.0), add(n - 1, 19.0), add(n - 2, -5.0), add(n - 3, 1.0);
    } else {
      add(i - 1, -1.0), add(i, 13.0), add(i + 1, 13.0), add(i + 2, -1.0);
    }
  }
  return integral;
}

}  // namespace

MomentumEquation::MomentumEquation(const flow::Channel& channel, const flow::Fluid& fluid,
                                   const Rectangle& rectangle, Index n, double grading)
    : channel_(channel),
      fluid_(fluid),
      formula_(rectangle.formula),
      x_(ChannelCurve::nodes(channel.length, n, grading)),
      integral_(integral_to_end(n) *
                ChannelCurve::stretch(channel.length, n, grading).matrix().asDiagonal()),
      flux_(rectangle.momentum_factor * fluid.density.si()) {}

Array1 MomentumEquation::pressure(double flow_rate, double outlet, const Array1& zeta) const {
  const Array1 gap = channel_.height.si() + zeta, area = channel_.width.si() * gap;
  const Array1 friction =
      flow_rate * flow::duct_resistance(fluid_.viscosity, channel_.width, gap, formula_);
  const Array1 head = 0.5 * flux_ * flow_rate * flow_rate / area.square();
  return outlet + (integral_ * friction.matrix()).array() + head(head.size() - 1) - head;
}

Matrix MomentumEquation::slope(double flow_rate, const Array1& zeta) const {
  const Array1 gap = channel_.height.si() + zeta, area = channel_.width.si() * gap;
  const Array1 friction =
      flow_rate * flow::duct_resistance_slope(fluid_.viscosity, channel_.width, gap, formula_);
  const Array1 head = flux_ * flow_rate * flow_rate * channel_.width.si() / (area.square() * area);
  const Index last = head.size() - 1;
  Matrix slope = integral_ * friction.matrix().asDiagonal();
  slope.diagonal() += head.matrix();
  slope.col(last).array() -= head(last);
  return slope;
}

Choking MomentumEquation::choking(double flow_rate, const Array1& zeta,
                                  const Array1& compliance) const {
  const Array1 area = channel_.width.si() * (channel_.height.si() + zeta);
  const Array1 square =
      flux_ * flow_rate * flow_rate * channel_.width.si() * compliance / (area.square() * area);
  Index at = 0;
  const double largest = square.maxCoeff(&at);
  return {largest, x_(at)};
}

}  // namespace manoscope::twin
