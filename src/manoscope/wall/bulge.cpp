#include "manoscope/wall/bulge.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "manoscope/core/error.hpp"

namespace manoscope::wall {
namespace {

void require(bool holds, const std::string& where, const std::string& found, const char* mend) {
  if (!holds) throw InputError(where, found, mend);
}

bool positive(double value) { return value > 0.0 && std::isfinite(value); }

}  // namespace

void Membrane::validate(const std::string& where) const {
  require(positive(width.si()), where, fmt::format("wall width is {:g} mm", width.in(mm)),
          "Give a positive width such as \"1.7 mm\"");
  require(positive(thickness.si()), where,
          fmt::format("wall thickness is {:g} um", thickness.in(um)),
          "Give a positive thickness such as \"0.2 um\"");
  require(positive(youngs_modulus.si()), where,
          fmt::format("Young's modulus is {:g} Pa", youngs_modulus.si()),
          "Give a positive modulus such as \"250 GPa\"");
  require(poisson_ratio > -1.0 && poisson_ratio <= 0.5, where,
          fmt::format("Poisson ratio is {:g}", poisson_ratio), "It must lie in (-1, 0.5]");
  require(prestress.si() >= 0.0 && std::isfinite(prestress.si()), where,
          fmt::format("prestress is {:g} Pa", prestress.si()),
          "Give a tension, 0 or more: a compressed wall buckles and needs another wall law");
}

LongMembrane::LongMembrane(const Membrane& membrane) : membrane_(membrane) {
  membrane.validate("long membrane");
  const double a = 0.5 * membrane.width.si(), t = membrane.thickness.si();
  const double nu = membrane.poisson_ratio;
  linear_ = 2.0 * membrane.prestress.si() * t / (a * a);
  cubic_ = 4.0 / 3.0 * membrane.youngs_modulus.si() / (1.0 - nu * nu) * t / (a * a * a * a);
}

double LongMembrane::crest_si(double p) const {
  if (p == 0.0) return 0.0;
  // cubic z^3 + linear z = p. With z = 2 s sinh(u), s = sqrt(linear / (3 cubic)), the identity
  // 4 sinh^3 u + 3 sinh u = sinh 3u leaves sinh 3u = p / (2 cubic s^3).
  const double s = std::sqrt(linear_ / (3.0 * cubic_));
  const double unit = 2.0 * cubic_ * s * s * s;
  double z = std::abs(p) < 1e12 * unit ? 2.0 * s * std::sinh(std::asinh(p / unit) / 3.0)
                                       : std::cbrt(p / cubic_);
  // One Newton step takes out the round-off of the hyperbolic functions.
  z -= (pressure_si(z) - p) / (linear_ + 3.0 * cubic_ * z * z);
  return z;
}

double LongMembrane::crest_compliance(Length crest) const {
  const double stiffness = linear_ + 3.0 * cubic_ * crest.si() * crest.si();
  return stiffness > 0.0 ? 1.0 / stiffness : std::numeric_limits<double>::infinity();
}

Array1 LongMembrane::crest(const Array1& pressure) const {
  return pressure.unaryExpr([this](double p) { return crest_si(p); });
}

}  // namespace manoscope::wall
