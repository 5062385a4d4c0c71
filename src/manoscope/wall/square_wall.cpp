#include "manoscope/wall/square_wall.hpp"

#include <cmath>
#include <numbers>

namespace manoscope::wall {
namespace {

using std::numbers::pi;

/// Crest of the tensioned square over p a^2/(s0 t).
constexpr double kTensionedCrest = 0.294685413126;

/// Deflection of the tensioned square along its centre line over p a^2/(s0 t).
double tensioned(double s) {
  double sum = 0.5 * (1.0 - s * s);
  double sign = -16.0 / (pi * pi * pi);
  for (int n = 1; n <= 21; n += 2) {  // the last is 1e-17 of the first
    sum += sign * std::cos(0.5 * n * pi * s) / (n * n * n * std::cosh(0.5 * n * pi));
    sign = -sign;
  }
  return sum;
}

}  // namespace

SquarePlate::SquarePlate(const WallSection& section) : section_(section) {
  section.validate("square plate");
  compliance_ = 0.00126531909 * std::pow(section.width.si(), 4) / section.bending_stiffness();
}

double SquarePlate::shape(Length /*crest*/, double s) const {
  if (!(std::abs(s) < 1.0)) return 0.0;
  const double x = s * s;
  return (1.0 - x) * (1.0 - x) * (1.0 + x * (0.25938157 + x * (0.0099385 - 0.00142155 * x)));
}

SquareMembrane::SquareMembrane(const WallSection& section) : section_(section) {
  section.validate_tension("square membrane");
  const double a = section.half_width(), t = section.thickness.si();
  const double nu = section.poisson_ratio;
  law_.linear = section.prestress.si() * t / (kTensionedCrest * a * a);
  law_.cubic =
      (2.037 - 0.588 * nu) / (1.0 - nu) * section.youngs_modulus.si() * t / (a * a * a * a);
}

double SquareMembrane::shape(Length /*crest*/, double s) const {
  return std::abs(s) < 1.0 ? tensioned(s) / kTensionedCrest : 0.0;
}

}  // namespace manoscope::wall
