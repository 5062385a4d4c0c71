#include "manoscope/wall/circular_wall.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

#include "manoscope/core/error.hpp"

namespace manoscope::wall {
namespace {

WallSection chip(double nu, double prestress_mpa = 0.0) {
  return {2.0 * mm, 1.0 * um, 100.0 * GPa, nu, prestress_mpa * MPa};
}

/// Circular membrane by shooting (Runge-Kutta), an independent way: scaled radial tension N with
/// r N'' + 3 N' = -p^2 r/(8 N^2), slope -p r/(2 N), held edge (N + N' - S) - nu (N - S) = 0, all
/// for a = E t = 1 and prestress force S.
struct Shot {
  double edge, crest, mean;
};
Shot shoot(double centre, double p, double s, double nu) {
  const int n = 4000;
  double r = 0.0, tension = centre, slope = 0.0, fall = 0.0, area = 0.0;
  const double h = 1.0 / n;
  const auto rate = [&](double at, double t, double v) {
    return at == 0.0 ? -p * p / (32.0 * t * t) : -3.0 * v / at - p * p / (8.0 * t * t);
  };
  for (int i = 0; i < n; ++i) {
    const double k1 = rate(r, tension, slope);
    const double t2 = tension + 0.5 * h * slope, v2 = slope + 0.5 * h * k1;
    const double k2 = rate(r + 0.5 * h, t2, v2);
    const double t3 = tension + 0.5 * h * v2, v3 = slope + 0.5 * h * k2;
    const double k3 = rate(r + 0.5 * h, t3, v3);
    const double t4 = tension + h * v3, v4 = slope + h * k3;
    const double k4 = rate(r + h, t4, v4);
    const double next = tension + h / 6.0 * (slope + 2.0 * v2 + 2.0 * v3 + v4);
    const double middle = 0.5 * (tension + next);
    const double drop = h * p * (r + 0.5 * h) / (2.0 * middle);
    area += h * (fall + 0.5 * drop);
    fall += drop;
    slope += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
    tension = next;
    r += h;
  }
  return {tension + slope - s - nu * (tension - s), fall, (fall - area) / fall};
}
std::pair<double, double> crest_and_mean(double p, double s, double nu) {
  double low = std::max(0.3 * std::cbrt(p * p), 0.9 * s), high = s + 2.0 * std::cbrt(p * p);
  for (int k = 0; k < 60; ++k) {
    const double middle = 0.5 * (low + high);
    (shoot(middle, p, s, nu).edge > 0.0 ? high : low) = middle;
  }
  const Shot found = shoot(low, p, s, nu);
  return {found.crest, found.mean};
}

TEST(CircularPlate, IsTheClampedPlate) {
  // D w'''' in polar form: for w = c (a^2 - r^2)^2, lap lap w = 64 c.
  const CircularPlate law(chip(0.3));
  const double stiffness = chip(0.3).bending_stiffness();
  EXPECT_NEAR(law.crest(1.0 * Pa).si() * 64.0 * stiffness / 1e-12, 1.0, 1e-14);
  double sum = 0.0;
  for (int i = 0; i < 1000; ++i) sum += law.shape(Length{}, (i + 0.5) / 1000.0) / 1000.0;
  EXPECT_NEAR(law.mean_over_crest(Length{}) / sum, 1.0, 1e-6);  // midpoint rule
  EXPECT_NEAR(law.deflection(1.0 * Pa).si() / (8.0 / 15.0 * law.crest(1.0 * Pa).si()), 1.0, 1e-14);
}

/// Crest of a clamped disc in units of t under P = p a^4/(D t), an independent way: Foeppl and von
/// Karman's equations in s = r/a by central differences,
///
///   phi'' + phi'/s - phi/s^2 = 12 N phi + P s/2,        phi = w' (P lifts against phi),
///   u'' + u'/s - u/s^2 = -phi phi' - (1 - nu) phi^2/(2 s),  N = u' + phi^2/2 + nu u/s,
///
/// both zero at centre and edge, solved in turn until they stand still.
double disc_crest(double load, double nu) {
  constexpr int n = 800;
  const double h = 1.0 / n;
  // Solves f'' + f'/s - f/s^2 - k f = right by elimination.
  const auto solve = [&](const std::vector<double>& k, const std::vector<double>& right) {
    std::vector<double> upper(n + 1, 0.0), value(n + 1, 0.0);
    for (int i = 1; i < n; ++i) {
      const double s = i * h, low = 1.0 / (h * h) - 0.5 / (h * s);
      const double high = 1.0 / (h * h) + 0.5 / (h * s);
      const double middle = -2.0 / (h * h) - 1.0 / (s * s) - k[i] - low * upper[i - 1];
      upper[i] = high / middle;
      value[i] = (right[i] - low * value[i - 1]) / middle;
    }
    value[n] = 0.0;
    for (int i = n - 1; i >= 1; --i) value[i] -= upper[i] * value[i + 1];
    value[0] = 0.0;
    return value;
  };
  std::vector<double> tension(n + 1, 0.0), slope, none(n + 1, 0.0);
  double crest = 0.0, before = -1.0;
  while (std::abs(crest - before) > 1e-13) {
    before = crest;
    std::vector<double> stiffness(n + 1), right(n + 1);
    for (int i = 0; i <= n; ++i) stiffness[i] = 12.0 * tension[i], right[i] = 0.5 * load * i * h;
    slope = solve(stiffness, right);
    for (int i = 1; i < n; ++i) {
      right[i] = -slope[i] * (slope[i + 1] - slope[i - 1]) / (2.0 * h) -
                 0.5 * (1.0 - nu) * slope[i] * slope[i] / (i * h);
    }
    const std::vector<double> u = solve(none, right);
    for (int i = 1; i < n; ++i) {
      tension[i] =
          (u[i + 1] - u[i - 1]) / (2.0 * h) + 0.5 * slope[i] * slope[i] + nu * u[i] / (i * h);
    }
    crest = 0.0;
    for (int i = 0; i < n; ++i) crest -= 0.5 * h * (slope[i] + slope[i + 1]);
  }
  return crest;
}

TEST(CircularPlate, ErrsByTheStretchingItStates) {
  for (const double nu : {0.0, 0.3, 0.5}) {
    const double linear = disc_crest(1e-3, nu) * 1e3;  // per load; 1/64 but for the grid
    EXPECT_NEAR(64.0 * linear, 1.0, 1e-5) << nu;       // second order of 1/800
    const double crest = disc_crest(0.1 / linear, nu);
    const double taken = (1.0 - crest / 0.1) / (crest * crest);
    // Next order: (crest/t)^2 = 0.01, by a factor of about 1.
    EXPECT_NEAR(taken, (173.0 + 100.0 * nu - 73.0 * nu * nu) / 360.0, 0.02 * taken) << nu;
  }
}

TEST(CircularMembrane, HasHenckysCoefficient) {
  for (const double nu : {-0.9, 0.0, 0.25, 0.3, 0.5}) {
    const double crest = crest_and_mean(1.0, 0.0, nu).first;
    // Runge-Kutta of tension is exact to 1e-12; the midpoint drop leaves 1e-7.
    EXPECT_NEAR(CircularMembrane::hencky_coefficient(nu) * std::pow(crest, 3), 1.0, 1e-6) << nu;
  }
  EXPECT_NEAR(CircularMembrane::hencky_coefficient(0.3), 3.6, 0.05);  // the docstring's figure
}

TEST(CircularMembrane, IsExactAtBothEndsAndWithinTheStatedErrorBetween) {
  for (const double nu : {0.0, 0.3, 0.5}) {
    const double hencky = CircularMembrane::hencky_coefficient(nu);
    double worst = 0.0;
    for (double s = 1e-3; s < 1e2; s *= 2.0) {
      const double z = crest_and_mean(1.0, s, nu).first;
      const double law = 4.0 * s * z + hencky * z * z * z;
      worst = std::max(worst, std::abs(law - 1.0));
    }
    EXPECT_LT(worst, 0.02) << nu;
    EXPECT_GT(worst, 0.01) << nu;  // it is an interpolation
    EXPECT_NEAR(4e3 * crest_and_mean(1.0, 1e3, nu).first, 1.0, 1e-5);
    // Slack shape against the parabola's mean.
    const double fuller = crest_and_mean(1.0, 0.0, nu).second / (2.0 / 3.0) - 1.0;
    EXPECT_GT(fuller, 0.019);
    EXPECT_LT(fuller, 0.033);
  }
}

TEST(CircularMembrane, PressureIsItsFormulaAndCrestItsInverse) {
  const CircularMembrane law(chip(0.3, 50.0));
  const double z = 20e-6, a = 1e-3, t = 1e-6;
  const double expected = 4.0 * 50e6 * t * z / (a * a) + CircularMembrane::hencky_coefficient(0.3) *
                                                             1e11 * t * z * z * z / std::pow(a, 4);
  EXPECT_NEAR(law.pressure(20.0 * um).si() / expected, 1.0, 1e-14);
  EXPECT_NEAR(law.crest(law.pressure(20.0 * um)).si() / z, 1.0, 1e-14);
  EXPECT_THROW(CircularMembrane{chip(0.3, -1.0)}, InputError);
}

}  // namespace
}  // namespace manoscope::wall
