#include "manoscope/wall/strip_bending.hpp"

#include <array>
#include <cmath>
#include <numbers>

#include "manoscope/core/error.hpp"

namespace manoscope::wall {
namespace {

constexpr double kPi2 = std::numbers::pi * std::numbers::pi;

constexpr int kTerms = 30;  // of series() at |q| < 2: (2/pi^2)^30 = 2e-21

/// Coefficients of (-q)^k in f and g.
struct SeriesTable {
  std::array<double, kTerms> f, g;
};

/// f = 4 sum_odd 1/(n^2 pi^2 (n^2 pi^2 + q)) and g = 2 sum 1/(n^2 pi^2 (n^2 pi^2 + q)), expanded.
SeriesTable series_table() {
  SeriesTable made;
  double scale = 1.0 / (kPi2 * kPi2);
  for (int k = 0; k < kTerms; ++k) {
    const int order = 2 * k + 4;
    double zeta = 0.0;
    if (k == 0) {
      zeta = kPi2 * kPi2 / 90.0;
    } else if (k == 1) {
      zeta = kPi2 * kPi2 * kPi2 / 945.0;
    } else {
      for (int n = 100; n >= 1; --n) zeta += std::pow(n, -order);  // rest below 1e-15
    }
    made.f[k] = 4.0 * scale * zeta * (1.0 - std::pow(2.0, -order));  // odd n alone
    made.g[k] = 2.0 * scale * zeta;
    scale /= kPi2;
  }
  return made;
}

StripBending series(double q) {
  static const SeriesTable table = series_table();
  StripBending made{};
  double power = 1.0, before = 0.0, second = 0.0;  // (-q)^k, (-q)^(k - 1), (-q)^(k - 2)
  for (int k = 0; k < kTerms; ++k) {
    made.f += table.f[k] * power;
    made.f_slope -= table.f[k] * k * before;
    made.g += table.g[k] * power;
    made.h += 0.5 * table.g[k] * k * before;
    made.h_slope -= 0.5 * table.g[k] * k * (k - 1) * second;
    second = before;
    before = power;
    power *= -q;
  }
  return made;
}

/// sinh(sqrt(x))/sqrt(x) = 1 + x excess(x), for x of either sign.
double excess(double x) {
  double sum = 0.0, term = 1.0 / 6.0;
  for (int k = 0; k < 18; ++k) {
    sum += term;
    term *= x / ((2 * k + 4) * (2 * k + 5));
  }
  return sum;
}

}  // namespace

StripBending StripBending::at(double q) {
  MANO_ASSERT(q > -4.0 * kPi2 && q != -kPi2);
  if (std::abs(q) < 2.0) return series(q);
  StripBending made{};
  const double u = std::sqrt(std::abs(q));
  // t = tanh(u/2)/u and c = u coth u, or their circular twins, with slopes by q from their
  // differential equations.
  const double t = (q > 0.0 ? std::tanh(0.5 * u) : std::tan(0.5 * u)) / u;
  const double t_slope = (0.5 * (1.0 - q * t * t) - t) / (2.0 * q);
  made.f = (0.5 - t) / q;
  made.f_slope = -(t_slope + made.f) / q;
  if (q > 400.0) {  // coth u = 1 to round-off
    made.g = (1.0 / 3.0 - (u - 1.0) / q) / q;
    made.h = (1.0 / 6.0 - (0.75 - 1.0 / u) / u) / (q * q);
    made.h_slope = (-1.0 / 3.0 + (1.875 - 3.0 / u) / u) / (q * q * q);
    return made;
  }
  const double c = q > 0.0 ? u / std::tanh(u) : u / std::tan(u);
  const double c1 = (c - c * c + q) / (2.0 * q);
  const double c2 = (1.0 - c1 - 2.0 * c * c1) / (2.0 * q);
  const double big_c = (c - 1.0) / q, big_c1 = (c1 - big_c) / q, big_c2 = (c2 - 2.0 * big_c1) / q;
  made.g = (1.0 / 3.0 - big_c) / q;
  made.h = 0.5 * (big_c1 + made.g) / q;  // -g'/2, g' = -(C' + g)/q
  made.h_slope = (0.5 * big_c2 - 2.0 * made.h) / q;
  return made;
}

double strip_shape(double q, double s) {
  MANO_ASSERT(q > -kPi2);
  if (!(std::abs(s) < 1.0)) return 0.0;
  const double gap = (1.0 - s) * (1.0 + s);
  if (q < 16.0) {
    // (1 - s^2)/2 (S0 - S1 S2)/(q S0) with S = sinh(sqrt)/sqrt at q, q (1 + s)^2/4, q (1 - s)^2/4.
    const double x1 = 0.25 * q * (1.0 + s) * (1.0 + s), x2 = 0.25 * q * (1.0 - s) * (1.0 - s);
    const double e0 = excess(q), e1 = excess(x1), e2 = excess(x2);
    const double difference = e0 - 0.25 * (1.0 + s) * (1.0 + s) * e1 -
                              0.25 * (1.0 - s) * (1.0 - s) * e2 - q * gap * gap / 16.0 * e1 * e2;
    return 0.5 * gap * difference / (1.0 + q * e0);
  }
  const double u = std::sqrt(q), side = std::abs(s);
  const double ratio =
      std::exp(u * (side - 1.0)) * (1.0 + std::exp(-2.0 * u * side)) / (1.0 + std::exp(-2.0 * u));
  return (0.5 * gap - (1.0 - ratio) / (u * std::tanh(u))) / q;
}

}  // namespace manoscope::wall
