#include "manoscope/wall/tapered_membrane.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "manoscope/core/error.hpp"

namespace manoscope::wall {

TaperedMembrane::TaperedMembrane(Length length, const Membrane& membrane, const Preload& preload,
                                 std::optional<Length> influence_length)
    : length_(length.si()),
      influence_length_(influence_length.value_or(membrane.width / std::numbers::pi).si()),
      section_(membrane),
      preload_(preload) {
  const auto refuse = [](const std::string& found, const char* mend) {
    throw InputError("tapered membrane", found, mend);
  };
  if (!(length_ > 0.0) || !std::isfinite(length_)) {
    refuse(fmt::format("wall length is {:g} mm", length.in(mm)),
           "Give a positive length such as \"15.5 mm\"");
  }
  if (!(influence_length_ > 0.0) || !std::isfinite(influence_length_)) {
    refuse(fmt::format("influence length is {:g} m", influence_length_),
           "Give a positive length such as \"0.54 mm\"");
  }
  if (!std::isfinite(preload.load.si()) || !(std::abs(preload.lopsidedness) <= 2.0)) {
    refuse(fmt::format("preload is {:g} Pa with lopsidedness {:g}", preload.load.si(),
                       preload.lopsidedness),
           "Give a finite load and a lopsidedness in [-2, 2]");
  }
}

double TaperedMembrane::taper(double x) const {
  if (!(x > 0.0 && x < length_)) return 0.0;
  return std::expm1(-x / influence_length_) * std::expm1(-(length_ - x) / influence_length_);
}

Length TaperedMembrane::crest(double x, double pressure) const {
  const double held = preload_.load.si() * (1.0 + preload_.lopsidedness * (x / length_ - 0.5));
  return section_.crest(Pressure::from_si(pressure - held));
}

double TaperedMembrane::deflection(double x, double pressure) const {
  return taper(x) * kParabolaMean * crest(x, pressure).si();
}

double TaperedMembrane::compliance(double x, double pressure) const {
  return taper(x) * kParabolaMean * section_.crest_compliance(crest(x, pressure));
}

Array1 TaperedMembrane::deflection(const Array1& x, const Array1& pressure) const {
  MANO_ASSERT(x.size() == pressure.size());
  Array1 zeta(x.size());
  for (Index i = 0; i < x.size(); ++i) zeta(i) = deflection(x(i), pressure(i));
  return zeta;
}

Array1 TaperedMembrane::deflection(const Array1& x, Pressure pressure) const {
  return deflection(x, Array1::Constant(x.size(), pressure.si()));
}

}  // namespace manoscope::wall
