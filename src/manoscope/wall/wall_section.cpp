#include "manoscope/wall/wall_section.hpp"

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

void WallSection::validate(const std::string& where) const {
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
  require(std::isfinite(prestress.si()), where,
          fmt::format("prestress is {:g} MPa", prestress.in(MPa)),
          "Give a finite stress, tension positive");
  require(shear_correction >= 0.0 && shear_correction <= 1.0, where,
          fmt::format("shear correction is {:g}", shear_correction),
          "Give a value in (0, 1] such as 0.8333, or 0 for a wall rigid in shear");
}

void WallSection::validate_tension(const std::string& where) const {
  validate(where);
  require(prestress.si() >= 0.0, where, fmt::format("prestress is {:g} Pa", prestress.si()),
          "Give a tension, 0 or more: a compressed wall needs a law with bending (plate strip)");
}

double WallSection::plane_strain_modulus() const {
  return youngs_modulus.si() / (1.0 - poisson_ratio * poisson_ratio);
}

double WallSection::bending_stiffness() const {
  const double t = thickness.si();
  return plane_strain_modulus() * t * t * t / 12.0;
}

double WallSection::shear_stiffness() const {
  if (shear_correction == 0.0) return std::numeric_limits<double>::infinity();
  return shear_correction * youngs_modulus.si() / (2.0 * (1.0 + poisson_ratio)) * thickness.si();
}

}  // namespace manoscope::wall
