#include "manoscope/wall/bulge.hpp"

#include <cmath>

namespace manoscope::wall {

LongMembrane::LongMembrane(const Membrane& membrane) : membrane_(membrane) {
  membrane.validate_tension("long membrane");
  const double a = membrane.half_width(), t = membrane.thickness.si();
  law_.linear = 2.0 * membrane.prestress.si() * t / (a * a);
  law_.cubic = 4.0 / 3.0 * membrane.plane_strain_modulus() * t / (a * a * a * a);
}

double LongMembrane::shape(Length /*crest*/, double s) const {
  return std::abs(s) < 1.0 ? 1.0 - s * s : 0.0;
}

Array1 LongMembrane::crest(const Array1& pressure) const {
  return pressure.unaryExpr([this](double p) { return law_.crest(p); });
}

}  // namespace manoscope::wall
