#include "manoscope/wall/circular_wall.hpp"

#include <array>
#include <cmath>

namespace manoscope::wall {
namespace {

// B(x) = sum b_n x^n, x = (r/a)^2, scaled radial tension of a slack membrane:
// x B'' + 2 B' = -2/B^2, and (1 - nu) B + 2 B' = 0 at the held edge x = 1.
constexpr int kTerms = 120;

struct Tension {
  double value, slope;  ///< at the edge
  double opening;       ///< int_0^1 dx/B: crest over a (p a/(E t))^(1/3)
};

Tension tension_from(double centre) {
  std::array<double, kTerms> b{}, inverse{}, square{};  // B, 1/B, 1/B^2
  b[0] = centre;
  inverse[0] = 1.0 / centre;
  Tension made{centre, 0.0, inverse[0]};
  for (int n = 0; n + 1 < kTerms; ++n) {
    square[n] = 0.0;
    for (int k = 0; k <= n; ++k) square[n] += inverse[k] * inverse[n - k];
    b[n + 1] = -2.0 * square[n] / ((n + 1) * (n + 2));
    double sum = 0.0;
    for (int k = 1; k <= n + 1; ++k) sum -= b[k] * inverse[n + 1 - k];
    inverse[n + 1] = sum / centre;
    made.value += b[n + 1];
    made.slope += (n + 1) * b[n + 1];
    made.opening += inverse[n + 1] / (n + 2);
  }
  return made;
}

}  // namespace

CircularPlate::CircularPlate(const WallSection& section) : section_(section) {
  section.validate("circular plate");
  const double a = section.half_width();
  compliance_ = a * a * a * a / (64.0 * section.bending_stiffness());
}

double CircularPlate::shape(Length /*crest*/, double s) const {
  if (!(std::abs(s) < 1.0)) return 0.0;
  const double parabola = 1.0 - s * s;
  return parabola * parabola;
}

CircularMembrane::CircularMembrane(const WallSection& section) : section_(section) {
  section.validate_tension("circular membrane");
  const double a = section.half_width(), t = section.thickness.si();
  law_.linear = 4.0 * section.prestress.si() * t / (a * a);
  law_.cubic =
      hencky_coefficient(section.poisson_ratio) * section.youngs_modulus.si() * t / (a * a * a * a);
}

double CircularMembrane::hencky_coefficient(double poisson_ratio) {
  // (1 - nu) B + 2 B' at the edge rises with the tension at the centre. The series converges at the
  // edge for all centres above 1.3; the roots run from 1.48 (nu = -0.9) to 1.85 (nu = 0.5).
  double low = 1.3, high = 3.0;
  for (int k = 0; k < 60; ++k) {
    const double middle = 0.5 * (low + high);
    const Tension edge = tension_from(middle);
    ((1.0 - poisson_ratio) * edge.value + 2.0 * edge.slope > 0.0 ? high : low) = middle;
  }
  const double opening = tension_from(0.5 * (low + high)).opening;
  return 1.0 / (opening * opening * opening);
}

double CircularMembrane::shape(Length /*crest*/, double s) const {
  return std::abs(s) < 1.0 ? 1.0 - s * s : 0.0;
}

}  // namespace manoscope::wall
