#include "manoscope/wall/buckled_strip.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "manoscope/core/error.hpp"
#include "manoscope/wall/plate_strip.hpp"
#include "manoscope/wall/strip_bending.hpp"

namespace manoscope::wall {
namespace {

constexpr double kPi2 = std::numbers::pi * std::numbers::pi;
/// -u^2 at the first root u of tan u = u: the odd mode of a clamped strip.
constexpr double kOddMode = -20.190728556426629;

/// P at the tension n of a strip with the tension n0 at rest.
double load_at(double n, double rest) {
  return std::sqrt(std::max(n - rest, 0.0) / (12.0 * StripBending::at(n).h));
}

}  // namespace

StripSnap strip_snap(const WallSection& section) {
  section.validate("buckled strip");
  const auto refuse = [](const std::string& found, const char* mend) {
    throw InputError("buckled strip", found, mend);
  };
  if (section.shear_correction != 0.0) {
    refuse(
        fmt::format("shear correction is {:g}", section.shear_correction),
        "The snap of a strip that shears is not known here: give 0, or use the Foeppl-von Karman "
        "wall");
  }
  const Pressure buckles = PlateStrip::buckling_prestress(section);
  if (!(section.prestress < buckles)) {
    refuse(fmt::format("prestress is {:g} MPa, and the flat wall buckles at {:g} MPa",
                       section.prestress.in(MPa), buckles.in(MPa)),
           "Give more compression: a wall that is not buckled does not snap");
  }
  const double a = section.half_width(), t = section.thickness.si();
  const double stiffness = section.bending_stiffness();
  const double rest = section.prestress.si() * t * a * a / stiffness;
  // h is convex between its poles, so that h - (n - n0) h' falls there and has one root.
  double low = std::max(rest, -4.0 * kPi2), high = -kPi2;
  for (int k = 0; k < 200; ++k) {
    const double n = 0.5 * (low + high);
    if (n == low || n == high) break;
    const StripBending bent = StripBending::at(n);
    (bent.h > (n - rest) * bent.h_slope ? low : high) = n;
  }
  const double limit = 0.5 * (low + high);
  const Pressure scale = Pressure::from_si(stiffness * t / (a * a * a * a));
  StripSnap made;
  made.limit = load_at(limit, rest) * scale;
  if (limit < kOddMode) made.bifurcation = load_at(kOddMode, rest) * scale;
  return made;
}

}  // namespace manoscope::wall
