#pragma once

#include <concepts>

#include "manoscope/core/arrays.hpp"
#include "manoscope/core/units.hpp"
#include "manoscope/wall/wall_section.hpp"

namespace manoscope::wall {

/// What every wall law can answer: how one cross-section of a uniform wall deflects under one
/// pressure. Laws are small values; they share this interface, no base class.
///
///   section()               the wall it describes
///   pressure(crest)         pressure that holds a crest deflection
///   crest(pressure)         its inverse
///   crest_compliance(crest) d crest/d pressure there, m/Pa
///   shape(crest, s)         deflection over crest at s = 2 z/w in [-1, 1], 0 beyond
///   mean_over_crest(crest)  mean of the shape over s: width average over crest
///   deflection(pressure)    width-averaged deflection, mean_over_crest times crest
///
/// All laws are odd: a pressure inward gives the mirrored deflection. For round and square walls
/// "width" is the line through the centre.
template <class Law>
concept WallLaw = requires(const Law& law, Length crest, Pressure pressure, double s) {
  { law.section() } -> std::same_as<const WallSection&>;
  { law.pressure(crest) } -> std::same_as<Pressure>;
  { law.crest(pressure) } -> std::same_as<Length>;
  { law.crest_compliance(crest) } -> std::same_as<double>;
  { law.shape(crest, s) } -> std::same_as<double>;
  { law.mean_over_crest(crest) } -> std::same_as<double>;
  { law.deflection(pressure) } -> std::same_as<Length>;
};

/// Width-averaged deflections under many pressures: (n), Pa -> (n), m.
template <WallLaw Law>
Array1 deflection(const Law& law, const Array1& pressure) {
  return pressure.unaryExpr([&](double p) { return law.deflection(Pressure::from_si(p)).si(); });
}

}  // namespace manoscope::wall
