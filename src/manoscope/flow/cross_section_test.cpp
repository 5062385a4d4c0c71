#include "manoscope/flow/cross_section.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "manoscope/core/error.hpp"
#include "manoscope/flow/duct_resistance.hpp"
#include "manoscope/flow/spectral.hpp"
#include "tests/support/reference_table.hpp"

namespace manoscope::flow {
namespace {

constexpr double kPi = std::numbers::pi;

/// An exact solution under a curved roof, w = 2, gap about 0.3 to 0.45: the flow of a rectangular
/// duct of height 0.5 less harmonic functions that vanish on the floor and the sides. Its roof is
/// where it is zero.
class ExactSection {
 public:
  explicit ExactSection(double skew) : skew_(skew) {}

  double u(double z, double y) const { return at(z, y).u; }

  double gap(double z) const {
    double low = 0.02, high = 0.5;
    for (int halving = 0; halving < 30; ++halving) {
      const double middle = 0.5 * (low + high);
      (ratio(z, middle) > 0.0 ? low : high) = middle;
    }
    double y = 0.5 * (low + high);
    for (int newton = 0; newton < 3 && std::abs(z) < 1.0; ++newton) {
      const Value v = at(z, y);
      y -= v.u / v.by_y;
    }
    return y;
  }

  double slope(double z) const {
    const Value v = at(z, gap(z));
    return -v.by_z / v.by_y;
  }

  Roof roof() const {
    return {2.0 * metre, [this](double s) { return gap(s); },
            [this](double s) { return slope(s); }};
  }

  /// Mean shear on the floor.
  double floor_shear() const {
    const QuadratureRule rule = gauss_legendre(120);
    double sum = 0.0;
    for (Index i = 0; i < 120; ++i) sum += rule.weights(i) * at(rule.nodes(i), 0.0).by_y;
    return 0.5 * sum;
  }

 private:
  struct Value {
    double u = 0.0, by_z = 0.0, by_y = 0.0;
  };

  Value at(double z, double y) const {
    const double H = 0.5;
    Value v{0.5 * y * (H - y), 0.0, 0.5 * H - y};
    for (int n = 1; n < 4000; n += 2) {
      const double k = n * kPi / H, left = std::exp(-k * (1.0 + z)), right = std::exp(-k * (1 - z));
      if (left < 1e-17 && right < 1e-17) break;
      const double size = -4.0 * H * H / (kPi * kPi * kPi * n * n * n) / (1.0 + std::exp(-2 * k));
      v.u += size * (left + right) * std::sin(k * y);
      v.by_z += size * k * (right - left) * std::sin(k * y);
      v.by_y += size * k * (left + right) * std::cos(k * y);
    }
    const auto add = [&](double size, double k, double across, double across_slope) {
      v.u += size * across * std::sinh(k * y);
      v.by_z += size * across_slope * std::sinh(k * y);
      v.by_y += size * k * across * std::cosh(k * y);
    };
    const double k1 = 0.5 * kPi, k2 = kPi, k3 = 1.5 * kPi;
    add(-0.006, k1, std::cos(k1 * z), -k1 * std::sin(k1 * z));
    add(-0.003, k3, -std::cos(k3 * z), k3 * std::sin(k3 * z));
    add(skew_, k2, std::sin(k2 * z), k2 * std::cos(k2 * z));
    return v;
  }

  /// u over the distance from the side, which does not vanish there.
  double ratio(double z, double y) const {
    if (std::abs(z) < 1.0) return at(z, y).u;
    return z > 0.0 ? -at(z, y).by_z : at(z, y).by_z;
  }

  double skew_;
};

struct Moments {
  double area = 0.0, flux = 0.0, beta = 0.0, alpha = 0.0;
};

Moments moments(const ExactSection& exact) {
  const QuadratureRule across = gauss_legendre(120), up = gauss_legendre(40);
  double area = 0.0, flux = 0.0, square = 0.0, cube = 0.0;
  for (Index i = 0; i < across.nodes.size(); ++i) {
    const double h = exact.gap(across.nodes(i));
    for (Index j = 0; j < up.nodes.size(); ++j) {
      const double weight = across.weights(i) * up.weights(j) * 0.5 * h;
      const double u = exact.u(across.nodes(i), 0.5 * h * (1.0 + up.nodes(j)));
      area += weight;
      flux += weight * u;
      square += weight * u * u;
      cube += weight * u * u * u;
    }
  }
  return {area, flux, area * square / (flux * flux), area * area * cube / (flux * flux * flux)};
}

TEST(CrossSection, OfARectangleIsTheExactSeries) {
  for (const double ratio : {0.05, 0.1, 0.15, 0.2, 0.5, 1.0}) {
    const CrossSection section = solve_cross_section(flat_roof(2.0 * mm, ratio * 2.0 * mm));
    const double series =
        duct_resistance(1.0 * mPa_s, 2.0 * mm, ratio * 2.0 * mm, DuctFormula::series);
    // The docstring's claim; the corner's r^2 ln r bounds the degree 20 from floor to roof.
    EXPECT_NEAR(section.resistance(1.0 * mPa_s) / series, 1.0, ratio <= 0.2 ? 1.5e-9 : 5e-9)
        << ratio;
    EXPECT_NEAR(section.flow_factor(), duct_flow_factor(ratio, DuctFormula::series), 5e-9);
    // Shear on the floor of height H = 1: 1/2 - sum over odd n of 4/(pi n)^2 tanh(k a)/(k a).
    double floor = 0.5;
    for (int n = 20001; n >= 1; n -= 2) {
      const double ka = 0.5 * n * kPi / ratio;
      floor -= 4.0 / (kPi * kPi * n * n) * std::tanh(ka) / ka;
    }
    const double side = 0.5 / ratio - floor / ratio;  // both balance the pressure on the section
    EXPECT_NEAR(section.floor_shear / (ratio * 2e-3) / floor, 1.0, ratio <= 0.2 ? 2e-5 : 5e-5)
        << ratio;
    EXPECT_NEAR(section.side_shear / (ratio * 2e-3) / side, 1.0, 3e-4) << ratio;
  }
}

TEST(CrossSection, TendsToParallelPlatesForAThinGap) {
  const CrossSection section = solve_cross_section(flat_roof(10.0 * mm, 0.1 * mm));
  // Side walls of a gap of 1/100: F = 1 - 0.0063; beta, alpha as far from 6/5, 54/35; a side layer
  // of 1/300 of the width is at the edge of degree 80.
  EXPECT_NEAR(section.flow_factor(), duct_flow_factor(0.01, DuctFormula::series), 1e-6);
  EXPECT_NEAR(section.momentum_factor, 1.2, 0.005);
  EXPECT_NEAR(section.energy_factor, 54.0 / 35.0, 0.015);
  // Shah & London (1978), eq. (341): a polynomial in h/w, within 0.05 %.
  EXPECT_NEAR(section.friction_reynolds() / (24.0 * (1.0 - 0.013553 + 0.00019467)), 1.0, 5e-4);
}

TEST(CrossSection, ConvergesAtLeastWithTheSixthOrderOfTheDegree) {
  double before = 0.0;
  for (const int degree : {8, 12, 18}) {
    CrossSectionOptions options;
    options.degree_across = 80;
    options.degree_up = degree;
    const double error =
        std::abs(solve_cross_section(flat_roof(1.0 * mm, 1.0 * mm), options).flow_factor() /
                     duct_flow_factor(1.0, DuctFormula::series) -
                 1.0);
    // r^2 ln r in the corners: the energy of the error falls with degree^-8; 1.5^6 = 11.
    if (before > 0.0) {
      EXPECT_GT(before / error, 11.0) << degree;
    }
    before = error;
  }
  EXPECT_LT(before, 1e-8);
}

TEST(CrossSection, IsExactUnderACurvedRoof) {
  for (const double skew : {0.0, 0.002}) {
    const ExactSection exact(skew);
    const Moments truth = moments(exact);
    const CrossSection section = solve_cross_section(exact.roof());
    // The series of the truth stops at n = 4000: 1e-8 of the roof's slope next to the sides.
    EXPECT_NEAR(section.area / truth.area, 1.0, 1e-9) << skew;
    EXPECT_NEAR(section.conductance / truth.flux, 1.0, 2e-8) << skew;
    EXPECT_NEAR(section.momentum_factor / truth.beta, 1.0, 2e-8) << skew;
    EXPECT_NEAR(section.energy_factor / truth.alpha, 1.0, 4e-8) << skew;
    EXPECT_NEAR(section.floor_shear / exact.floor_shear(), 1.0, 2e-5) << skew;
  }
}

TEST(CrossSection, WallShearsBalanceThePressureGradient) {
  for (const double deflection : {-20.0, 0.0, 33.0}) {
    const CrossSection section = solve_cross_section(
        bulged_roof(1.7 * mm, 175.0 * um, deflection * um, WallShape::parabola()));
    const double force = section.floor_shear * 1.7e-3 + section.roof_shear * section.roof_length +
                         section.side_shear * section.side_height;
    // The docstring's claim: slopes lose two orders against the resistance.
    EXPECT_NEAR(force / section.area, 1.0, 2e-5) << deflection;
    EXPECT_GT(section.side_shear, 0.0);
    EXPECT_LT(section.side_shear, section.floor_shear);  // the corners are slow
  }
}

TEST(CrossSection, OfAHalfCircleIsTheSeriesOfTheSector) {
  // Half disc of radius 1: u = sum over odd n of c_n (r^n - r^2) sin(n theta), c_n = 4/(pi n (4 -
  // n^2)), which is the sector of F. M. White, Viscous Fluid Flow (1991), ch. 3, at its angle pi,
  // integrated over the half disc.
  double truth = 0.0;
  for (int n = 2001; n >= 1; n -= 2) {
    const double c = 4.0 / (kPi * n * (n * n - 4.0));
    truth += -c * (1.0 / (n + 2.0) - 0.25) * 2.0 / n;
  }
  truth = std::abs(truth);
  const Roof half_circle{2.0 * metre,
                         [](double s) { return std::sqrt(std::max(0.0, 1.0 - s * s)); },
                         [](double s) { return -s / std::sqrt(1.0 - s * s); }};
  CrossSectionOptions options;
  options.degree_across = 60;
  // The roof is vertical at the sides: algebraic convergence across, 4e-8 at degree 60.
  EXPECT_NEAR(solve_cross_section(half_circle, options).conductance / truth, 1.0, 2e-7);
}

TEST(CrossSection, AgreesWithTheReferenceTableOfRectangles) {
  const auto path = shared_file("data/flow/caseC.csv");
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "no reference table " << path;
  const auto rows = read_table(path);
  ASSERT_GT(rows.size(), 10u);
  for (const auto& row : rows) {
    const CrossSection section = solve_cross_section(flat_roof(1.7 * mm, row[0] * 1.7 * mm));
    // The table holds ten digits; below h/w = 0.05 the side layers want more than degree 60.
    const double tolerance = row[0] < 0.05 ? 1e-7 : 5e-9;
    EXPECT_NEAR(section.flow_factor() / row[1], 1.0, tolerance) << row[0];
    EXPECT_NEAR(section.momentum_factor / row[5], 1.0, tolerance) << row[0];
    EXPECT_NEAR(section.energy_factor / row[6], 1.0, 2.0 * tolerance) << row[0];
  }
}

TEST(CrossSection, AgreesWithTheReferenceTableOfBulgedSections) {
  const auto path = shared_file("data/flow/bump_section.csv");
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "no reference table " << path;
  const auto rows = read_table(path);
  ASSERT_GT(rows.size(), 10u);
  for (const auto& row : rows) {
    const CrossSection section = solve_cross_section(
        bulged_roof(1.7 * mm, 175.0 * um, row[0] * 175.0 * um, WallShape::parabola()));
    // The reference's own digits: its row 0 differs from the series by 1.5e-9, and ours from it
    // too.
    EXPECT_NEAR(section.flow_factor() / row[1], 1.0, 1e-8) << row[0];
    EXPECT_NEAR(section.momentum_factor / row[5], 1.0, 1e-8) << row[0];
    EXPECT_NEAR(section.energy_factor / row[6], 1.0, 2e-8) << row[0];
    // Error of eq. (4) at the mean gap, as the reference counts it: r(eq. 4)/r - 1.
    const double eq4 = duct_resistance(1.0 * mPa_s, 1.7 * mm, (1.0 + row[0]) * 175.0 * um);
    EXPECT_NEAR(eq4 / section.resistance(1.0 * mPa_s) - 1.0, row[3], 5e-5) << row[0];
  }
}

TEST(CrossSection, OfAMirroredRoofIsTheSame) {
  const auto skewed = [](double sign) {
    return Roof{1.7 * mm,
                [sign](double s) { return 1e-6 * (180.0 + 20.0 * sign * s - 10.0 * s * s); },
                [sign](double s) { return 1e-6 * (20.0 * sign - 20.0 * s); }};
  };
  const CrossSection left = solve_cross_section(skewed(-1.0)),
                     right = solve_cross_section(skewed(1.0));
  EXPECT_NEAR(left.conductance / right.conductance, 1.0, 1e-13);  // round-off
  EXPECT_NEAR(left.side_shear / right.side_shear, 1.0, 1e-10);
  // The odd part counts in second order: 3 (20/180)^2 <s^2> = 1.2 % of the conductance between
  // plates, less by the side layers, which lie where it is largest.
  const CrossSection even = solve_cross_section(skewed(0.0));
  EXPECT_NEAR(right.conductance / even.conductance - 1.0, 0.0125, 0.005);
}

TEST(CrossSection, RefusesASectionThatIsClosed) {
  EXPECT_THROW(flat_roof(1.7 * mm, Length{}), InputError);
  EXPECT_THROW(flat_roof(Length{}, 100.0 * um), InputError);
  EXPECT_THROW(bulged_roof(1.7 * mm, 100.0 * um, -70.0 * um, WallShape::parabola()), InputError);
  const Roof pinched{1.7 * mm, [](double s) { return 1e-4 * (s * s - 0.01); },
                     [](double s) { return 2e-4 * s; }};
  EXPECT_THROW(solve_cross_section(pinched), InputError);
  EXPECT_THROW(solve_cross_section(flat_roof(1.7 * mm, 175.0 * um), {2, 20}), InputError);
}

TEST(WallShape, HasMeanOneAndAnExactSlope) {
  const QuadratureRule rule = gauss_legendre(20);
  for (const WallShape& shape : {WallShape::parabola(), WallShape::clamped_strip(),
                                 WallShape({2.0, -1.0, -3.0, 2.0}), WallShape::rigid()}) {
    double mean = 0.0;
    for (Index i = 0; i < 20; ++i) mean += 0.5 * rule.weights(i) * shape.value(rule.nodes(i));
    EXPECT_NEAR(mean, 1.0, 1e-14);
    const double step = 1e-6;
    const double difference = (shape.value(0.4 + step) - shape.value(0.4 - step)) / (2.0 * step);
    EXPECT_NEAR(shape.slope(0.4), difference, 1e-8);  // round-off 1e-16/step
  }
  EXPECT_NEAR(WallShape::parabola().crest(), 1.5, 1e-15);
  EXPECT_NEAR(WallShape::clamped_strip().crest(), 1.875, 1e-15);
  EXPECT_THROW(WallShape({}), InputError);
  EXPECT_THROW(WallShape({1.0, -3.0}), InputError);
}

TEST(WallShape, IsFoundAgainFromASection) {
  const Array1 s = Array1::LinSpaced(41, -0.97, 0.97);
  const WallShape truth = WallShape::clamped_strip();
  // The odd part is left out, the even part comes back to round-off.
  const Array1 zeta =
      3e-6 * (s.unaryExpr([&](double v) { return truth.value(v); }) + 0.1 * s * s * s);
  const WallShape fitted = WallShape::fit(s, zeta, 2);
  for (const double at : {0.0, 0.5, 0.9}) EXPECT_NEAR(fitted.value(at), truth.value(at), 1e-12);
  EXPECT_THROW(WallShape::fit(s, zeta.head(3), 2), InputError);
  EXPECT_THROW(WallShape::fit(3.0 * s, zeta, 2), InputError);
}

}  // namespace
}  // namespace manoscope::flow
