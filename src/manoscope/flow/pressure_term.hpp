#pragma once

#include <optional>
#include <string>
#include <vector>

#include "manoscope/core/uncertainty.hpp"
#include "manoscope/core/units.hpp"

namespace manoscope::flow {

/// One part of a pressure drop, static pressure before less static pressure behind, and what moves
/// it.
struct PressureTerm {
  std::string name;
  std::string source;
  Pressure drop{};
  Pressure uncertainty{};  ///< standard, of the formula alone: sizes and fluid are not in it
  /// The formula whose error that is: terms of one formula, in whichever passage, err together.
  std::string formula;
  Pressure by_flow_rate{};   ///< Q d(drop)/dQ: once a viscous part, twice an inertial one
  Pressure by_viscosity{};   ///< eta d(drop)/d(eta)
  Pressure height_effect{};  ///< of one standard deviation of the passage's height
};

/// Relative standard uncertainties of what flows, the same errors in all terms.
struct PassageUncertainty {
  double flow_rate = 0.0, viscosity = 0.0;
};

/// Sum of the terms with its error variables:
///
///   "parasitic drop, <formula>"  one for all terms of a formula: their effects add up linearly
///   "passage height"             one for all passages, as they are made in one go: linear, too
///   "flow rate", "viscosity"     the names under which a modelled drop has the same errors
///
/// Errors of different formulas are independent.
Estimate parasitic_estimate(const std::vector<PressureTerm>& terms,
                            const PassageUncertainty& uncertainty);

/// Drop of the compliant channel as the transducer has it: reading less parasitic drop.
///
/// Source: Ozsun, Yakhot & Ekinci (2013), fig. 2(a).
/// @param uncertainty  standard, of the transducer's reading; not known: the uncertainty of the
///                     result is NaN, too.
Estimate compliant_drop(Pressure transducer, std::optional<Pressure> uncertainty,
                        const Estimate& parasitic);

}  // namespace manoscope::flow
