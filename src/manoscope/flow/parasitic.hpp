#pragma once

#include "manoscope/core/units.hpp"

namespace manoscope::flow {

/// A rigid passage of constant rectangular section between the channel and a pressure gauge.
struct RigidPassage {
  Length length{}, width{}, height{};
  Length height_uncertainty{};  ///< standard; 0 = exact
  friend bool operator==(const RigidPassage&, const RigidPassage&) = default;
};

/// Pressure drop of a rigid passage: the paper's "parasitic pressure drop".
///
///   Q r l with the exact r of a rectangular duct (duct_resistance(), series)
///
/// Source: the fully developed part of what the paper takes from flow simulations (its appendix A).
/// Validity: fully developed laminar flow all along, so length >> 0.05 Re Dh. Developing flow,
/// bends, contractions and expansions are not in it (passage_terms() has them), so it is a lower
/// bound at high flow rates.
/// @throws InputError if a size or the viscosity is not positive.
Pressure passage_drop(Viscosity eta, FlowRate flow_rate, const RigidPassage& passage);

}  // namespace manoscope::flow
