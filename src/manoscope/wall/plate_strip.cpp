#include "manoscope/wall/plate_strip.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "manoscope/core/error.hpp"
#include "manoscope/wall/strip_bending.hpp"

namespace manoscope::wall {
namespace {

constexpr double kPi2 = std::numbers::pi * std::numbers::pi;
constexpr int kMostSteps = 200;

/// D/(kappa G t a^2).
double shear_number(const WallSection& section) {
  const double a = section.half_width();
  return section.bending_stiffness() / (section.shear_stiffness() * a * a);
}

bool settled(double step, double value) {
  return std::abs(step) <= 4.0 * std::numeric_limits<double>::epsilon() * (1.0 + std::abs(value));
}

}  // namespace

Pressure PlateStrip::buckling_prestress(const WallSection& section) {
  const double a = section.half_width();
  return Pressure::from_si(-kPi2 / (1.0 + kPi2 * shear_number(section)) *
                           section.bending_stiffness() / (a * a * section.thickness.si()));
}

PlateStrip::PlateStrip(const WallSection& section) : section_(section) {
  section.validate("plate strip");
  const double a = section.half_width(), t = section.thickness.si();
  const double stiffness = section.bending_stiffness();
  shear_ = shear_number(section);
  rest_ = section.prestress.si() * t * a * a / stiffness;
  load_ = stiffness * t / (a * a * a * a);
  const Pressure limit = buckling_prestress(section);
  // A hair's breadth above the limit the answers are all round-off.
  if (!(section.prestress.si() > (1.0 - 1e-9) * limit.si())) {
    throw InputError("plate strip",
                     fmt::format("prestress is {:g} MPa, and the flat wall buckles at {:g} MPa",
                                 section.prestress.in(MPa), limit.in(MPa)),
                     "A buckled wall has two branches: use the Foeppl-von Karman wall, or give a "
                     "prestress above the limit");
  }
}

PlateStrip::Answer PlateStrip::answer(double tension) const {
  const double e = shear_, r = 1.0 / (1.0 + e * tension), r2 = r * r;
  MANO_ASSERT(r * tension > -kPi2);
  const StripBending bent = StripBending::at(r * tension);
  Answer made{};
  made.crest = r2 * bent.f + 0.5 * r * e;
  made.average = r2 * bent.g + r * e / 3.0;
  const double sum = r2 * bent.h + r * e * bent.g + e * e / 6.0;
  made.stretch = r2 * sum;
  // dr/dn = -e r^2, dq/dn = r^2, dg/dq = -2 h.
  made.crest_slope = r2 * (r2 * bent.f_slope - 2.0 * r * e * bent.f - 0.5 * e * e);
  made.stretch_slope =
      r2 * (r2 * r2 * bent.h_slope - 4.0 * r2 * r * e * bent.h - r2 * e * e * bent.g) -
      2.0 * e * r2 * r * sum;
  return made;
}

double PlateStrip::tension_under(double load) const {
  // n - rest - 12 P^2 stretch(n) rises with n and is concave: from above Newton steps once below
  // the root, from below it climbs to it. stretch < 1/(6 n^2) gives the start above.
  const double drive = 12.0 * load * load;
  if (drive == 0.0) return rest_;
  double n = std::max(rest_, 0.0) + std::cbrt(2.0 * load * load);
  for (int k = 0; k < kMostSteps; ++k) {
    const Answer now = answer(n);
    const double next =
        std::max(rest_, n - (n - rest_ - drive * now.stretch) / (1.0 - drive * now.stretch_slope));
    if (settled(next - n, n)) return next;
    n = next;
  }
  return n;
}

double PlateStrip::tension_at(double crest) const {
  // n = rest + 12 z^2 k(n), k = stretch/crest^2 between 0.6095 (bending) and 2/3 (membrane).
  const double drive = 12.0 * crest * crest;
  if (drive == 0.0) return rest_;
  double low = rest_, high = rest_ + 0.7 * drive, n = rest_ + 0.64 * drive;
  for (int k = 0; k < kMostSteps; ++k) {
    const Answer now = answer(n);
    const double ratio = now.stretch / (now.crest * now.crest);
    const double slope =
        now.stretch_slope / (now.crest * now.crest) - 2.0 * ratio * now.crest_slope / now.crest;
    const double excess = n - rest_ - drive * ratio;
    (excess > 0.0 ? high : low) = n;
    double next = n - excess / (1.0 - drive * slope);
    if (!(next >= low && next <= high)) next = 0.5 * (low + high);
    if (settled(next - n, n)) return next;
    n = next;
  }
  return n;
}

Pressure PlateStrip::pressure(Length crest) const {
  const double z = crest.si() / section_.thickness.si();
  return Pressure::from_si(load_ * z / answer(tension_at(z)).crest);
}

Length PlateStrip::crest(Pressure pressure) const {
  const double load = pressure.si() / load_;
  return load * answer(tension_under(load)).crest * section_.thickness;
}

Length PlateStrip::deflection(Pressure pressure) const {
  const double load = pressure.si() / load_;
  return load * answer(tension_under(load)).average * section_.thickness;
}

double PlateStrip::crest_compliance(Length crest) const {
  const double z = crest.si() / section_.thickness.si();
  const Answer now = answer(tension_at(z));
  const double load = z / now.crest;
  const double growth =
      24.0 * load * now.stretch / (1.0 - 12.0 * load * load * now.stretch_slope);  // dn/dP
  return (now.crest + load * now.crest_slope * growth) * section_.thickness.si() / load_;
}

double PlateStrip::deflection_compliance(Pressure pressure) const {
  const double load = pressure.si() / load_;
  const Answer now = answer(tension_under(load));
  const double growth = 24.0 * load * now.stretch / (1.0 - 12.0 * load * load * now.stretch_slope);
  return (now.average - 2.0 * load * now.stretch * growth) * section_.thickness.si() / load_;
}

double PlateStrip::shape(Length crest, double s) const {
  if (!(std::abs(s) < 1.0)) return 0.0;
  const double n = tension_at(crest.si() / section_.thickness.si());
  const double e = shear_, r = 1.0 / (1.0 + e * n);
  return (r * r * strip_shape(r * n, s) + 0.5 * r * e * (1.0 - s * s)) / answer(n).crest;
}

double PlateStrip::mean_over_crest(Length crest) const {
  const Answer now = answer(tension_at(crest.si() / section_.thickness.si()));
  return now.average / now.crest;
}

double PlateStrip::tension(Pressure pressure) const {
  const double a = section_.half_width();
  return tension_under(pressure.si() / load_) * section_.bending_stiffness() / (a * a);
}

}  // namespace manoscope::wall
