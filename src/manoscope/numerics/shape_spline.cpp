#include "manoscope/numerics/shape_spline.hpp"

#include <algorithm>
#include <cmath>

#include "manoscope/core/error.hpp"

namespace manoscope::numerics {
namespace {

/// A slope and its derivatives with respect to the three values it was formed from.
struct Slope {
  double value = 0.0;
  std::array<double, 3> derivative{};
};

/// Slope of the middle of three knots: that of the parabola u(y) through them, a harmonic mean of
/// the two secants weighted by the rises, at most three times the smaller.
Slope middle_slope(const double* u, const double* y) {
  const double h0 = u[1] - u[0], h1 = u[2] - u[1], z0 = y[1] - y[0], z1 = y[2] - y[1];
  const double s0 = z0 / h0, s1 = z1 / h1;
  Slope slope;
  if (s0 * s1 <= 0.0) return slope;
  const double steepness = h0 * z1 / z0 + h1 * z0 / z1;
  slope.value = (z0 + z1) / steepness;
  if (std::abs(slope.value) > 3.0 * std::min(std::abs(s0), std::abs(s1))) {
    if (std::abs(s0) <= std::abs(s1)) return {3.0 * s0, {-3.0 / h0, 3.0 / h0, 0.0}};
    return {3.0 * s1, {0.0, -3.0 / h1, 3.0 / h1}};
  }
  const double by_z0 = (1.0 + slope.value * (h0 * z1 / (z0 * z0) - h1 / z1)) / steepness;
  const double by_z1 = (1.0 + slope.value * (h1 * z0 / (z1 * z1) - h0 / z0)) / steepness;
  slope.derivative = {-by_z0, by_z0 - by_z1, by_z1};
  return slope;
}

/// Slope of the first of three knots (of the last, if they are given in reverse), between 0 and
/// three times the end secant: that of the parabola u(y) through them, which follows a curve that
/// sets off steeply better than a parabola y(u); of the latter where the curve turns.
Slope end_slope(double h0, double h1, double y0, double y1, double y2) {
  const double h = h0 + h1, z0 = y1 - y0, z1 = y2 - y1, z = y2 - y0, s0 = z0 / h0;
  Slope slope;
  if (z0 * z1 > 0.0) {
    // du/dy = steepness / z
    const double steepness = 2.0 * h0 + h0 * z1 / z0 - h1 * z0 / z1;
    if (steepness * h0 > 0.0) {
      slope.value = z / steepness;
      const double by_z0 = (1.0 + slope.value * (h0 * z1 / (z0 * z0) + h1 / z1)) / steepness;
      const double by_z1 = (1.0 - slope.value * (h0 / z0 + h1 * z0 / (z1 * z1))) / steepness;
      slope.derivative = {-by_z0, by_z0 - by_z1, by_z1};
    } else {
      slope.value = 4.0 * s0;  // vertical or beyond: to be limited
    }
  } else {
    slope.derivative = {-(h0 + h) / (h0 * h), h / (h0 * h1), -h0 / (h1 * h)};
    slope.value = slope.derivative[0] * y0 + slope.derivative[1] * y1 + slope.derivative[2] * y2;
  }
  if (slope.value * s0 <= 0.0) return {};
  if (std::abs(slope.value) > 3.0 * std::abs(s0)) {
    return {3.0 * s0, {-3.0 / h0, 3.0 / h0, 0.0}};
  }
  return slope;
}

/// Slope of the parabola through three knots at the middle one, limited so that the curve keeps the
/// shape of its data.
double parabola_slope(const double* u, const double* y) {
  const double h0 = u[1] - u[0], h1 = u[2] - u[1];
  const double s0 = (y[1] - y[0]) / h0, s1 = (y[2] - y[1]) / h1;
  if (s0 * s1 <= 0.0) return 0.0;
  const double slope = (s0 * h1 + s1 * h0) / (h0 + h1);
  const double bound = 3.0 * std::min(std::abs(s0), std::abs(s1));
  return std::abs(slope) <= bound ? slope : std::copysign(bound, slope);
}

struct Basis {
  double y0, y1, d0, d1;
};

/// Hermite basis at t in [0, 1] of an interval of length h, for values and slopes at its ends.
Basis value_basis(double t, double h) {
  const double r = 1.0 - t;
  return {(1.0 + 2.0 * t) * r * r, t * t * (3.0 - 2.0 * t), h * t * r * r, -h * t * t * r};
}

Basis derivative_basis(double t, double h) {
  const double r = 1.0 - t;
  return {-6.0 * t * r / h, 6.0 * t * r / h, r * (1.0 - 3.0 * t), t * (3.0 * t - 2.0)};
}

}  // namespace

ShapeSpline::ShapeSpline(std::vector<double> u, std::vector<double> y)
    : u_(std::move(u)), y_(std::move(y)) {
  const std::size_t n = u_.size();
  MANO_ASSERT(n >= 2 && y_.size() == n);
  for (std::size_t j = 1; j < n; ++j) MANO_ASSERT(u_[j] > u_[j - 1]);

  d_.resize(n);
  first_.assign(n, 0);
  stencil_.assign(n, {});
  if (n == 2) {
    const double h = u_[1] - u_[0];
    d_[0] = d_[1] = (y_[1] - y_[0]) / h;
    stencil_[0] = stencil_[1] = {-1.0 / h, 1.0 / h, 0.0};
    other_d_ = d_;
    return;
  }
  for (std::size_t j = 0; j < n; ++j) {
    const std::size_t first = std::min(j == 0 ? 0 : j - 1, n - 3);
    const double* const u3 = &u_[first];
    const double* const y3 = &y_[first];
    Slope slope;
    if (j == 0) {
      slope = end_slope(u3[1] - u3[0], u3[2] - u3[1], y3[0], y3[1], y3[2]);
    } else if (j == n - 1) {
      // Seen from the end, so that steps are negative and derivatives come in reverse.
      slope = end_slope(u3[1] - u3[2], u3[0] - u3[1], y3[2], y3[1], y3[0]);
      std::swap(slope.derivative[0], slope.derivative[2]);
    } else {
      slope = middle_slope(u3, y3);
    }
    first_[j] = static_cast<Index>(first);
    stencil_[j] = slope.derivative;
    d_[j] = slope.value;
    const bool at_end = j == 0 || j == n - 1;
    other_d_.push_back(at_end ? slope.value : parabola_slope(u3, y3));
  }
}

Index ShapeSpline::interval(double u) const {
  const auto above = std::upper_bound(u_.begin() + 1, u_.end() - 1, u);
  return static_cast<Index>(above - u_.begin()) - 1;
}

double ShapeSpline::value(double u) const {
  const auto j = static_cast<std::size_t>(interval(u));
  const double h = u_[j + 1] - u_[j];
  const Basis b = value_basis((u - u_[j]) / h, h);
  return b.y0 * y_[j] + b.y1 * y_[j + 1] + b.d0 * d_[j] + b.d1 * d_[j + 1];
}

double ShapeSpline::derivative(double u) const {
  const auto j = static_cast<std::size_t>(interval(u));
  const double h = u_[j + 1] - u_[j];
  const Basis b = derivative_basis((u - u_[j]) / h, h);
  return b.y0 * y_[j] + b.y1 * y_[j + 1] + b.d0 * d_[j] + b.d1 * d_[j + 1];
}

double ShapeSpline::doubt(double u) const {
  const auto j = static_cast<std::size_t>(interval(u));
  const double h = u_[j + 1] - u_[j];
  const Basis b = value_basis((u - u_[j]) / h, h);
  return b.d0 * (other_d_[j] - d_[j]) + b.d1 * (other_d_[j + 1] - d_[j + 1]);
}

std::vector<double> ShapeSpline::solve(double y) const {
  std::vector<double> roots;
  for (std::size_t j = 0; j + 1 < u_.size(); ++j) {
    const double y0 = y_[j], y1 = y_[j + 1];
    const bool last = j + 2 == u_.size();
    if (y0 == y1) {
      if (y == y0) roots.push_back(0.5 * (u_[j] + u_[j + 1]));
      continue;
    }
    // A knot belongs to the interval on its right, so that it is not counted twice.
    const bool inside = y0 < y1 ? (y >= y0 && (y < y1 || (last && y == y1)))
                                : (y <= y0 && (y > y1 || (last && y == y1)));
    if (!inside) continue;
    // Newton's steps kept inside a shrinking bracket; the interpolant is monotone here.
    double low = u_[j], high = u_[j + 1];
    double u = low + (high - low) * (y - y0) / (y1 - y0);
    constexpr int kSteps = 100;  // bisection alone reaches round-off in about 55
    for (int step = 0; step < kSteps; ++step) {
      const double miss = value(u) - y;
      if (miss == 0.0) break;
      ((miss < 0.0) == (y0 < y1) ? low : high) = u;
      const double slope = derivative(u);
      double next = slope != 0.0 ? u - miss / slope : low;
      if (!(next > low && next < high)) next = 0.5 * (low + high);
      if (std::abs(next - u) <= 4e-16 * (std::abs(u) + (high - low)) || next == u) break;
      u = next;
    }
    roots.push_back(u);
  }
  // A local extremum met exactly at a knot belongs to both its sides; keep one.
  roots.erase(std::unique(roots.begin(), roots.end()), roots.end());
  return roots;
}

std::vector<std::pair<Index, double>> ShapeSpline::weights(double u) const {
  const Index j = interval(u);
  const auto k = static_cast<std::size_t>(j);
  const double h = u_[k + 1] - u_[k];
  const Basis b = value_basis((u - u_[k]) / h, h);
  const Index lowest = std::min({j, first_[k], first_[k + 1]});
  const Index stencil_end = size() == 2 ? 1 : std::max(first_[k], first_[k + 1]) + 2;
  const Index highest = std::max(j + 1, stencil_end);
  std::vector<std::pair<Index, double>> result;
  for (Index i = lowest; i <= highest; ++i) result.emplace_back(i, 0.0);
  const auto add = [&](Index i, double weight) {
    result[static_cast<std::size_t>(i - lowest)].second += weight;
  };
  add(j, b.y0);
  add(j + 1, b.y1);
  const Index stencil_size = std::min<Index>(3, size());
  for (Index i = 0; i < stencil_size; ++i) {
    const auto at = static_cast<std::size_t>(i);
    add(first_[k] + i, b.d0 * stencil_[k][at]);
    add(first_[k + 1] + i, b.d1 * stencil_[k + 1][at]);
  }
  return result;
}

std::vector<std::pair<Index, double>> ShapeSpline::knot_weights(double u) const {
  // The interval and one knot to either side fix both slopes, hence the value.
  const Index j = interval(u);
  const Index first = std::max<Index>(0, std::min(j - 1, size() - 3));
  const Index last = std::min(size() - 1, std::max<Index>(j + 2, 2));
  const std::vector<double> u_near(u_.begin() + first, u_.begin() + last + 1);
  const std::vector<double> y_near(y_.begin() + first, y_.begin() + last + 1);
  double gap = u_near.back() - u_near.front();
  for (std::size_t k = 1; k < u_near.size(); ++k) gap = std::min(gap, u_near[k] - u_near[k - 1]);
  const double step = 1e-6 * gap;
  std::vector<std::pair<Index, double>> result;
  for (std::size_t k = 0; k < u_near.size(); ++k) {
    std::vector<double> above = u_near, below = u_near;
    above[k] += step;
    below[k] -= step;
    const double rise = ShapeSpline(above, y_near).value(u) - ShapeSpline(below, y_near).value(u);
    result.emplace_back(first + static_cast<Index>(k), rise / (above[k] - below[k]));
  }
  return result;
}

}  // namespace manoscope::numerics
