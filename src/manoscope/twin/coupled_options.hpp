#pragma once

#include <optional>
#include <string>

#include "manoscope/flow/flow_models.hpp"

namespace manoscope::twin {

/// Options of solve_coupled().
struct CoupledOptions {
  int steps = 240;  ///< over the channel
  /// What the flow obeys: "rectangle", or a name of flow::kFlowModels.
  std::string flow_model = "rectangle";
  std::string inlet_profile = "developed";  ///< of a march at x = 0; or "uniform"
  bool exact_duct = true;                   ///< of the rectangle; false: the paper's eq. (4)
  double momentum_factor = 1.2;             ///< beta of the rectangle; 0 = creeping flow

  template <class Visitor>
  void describe(Visitor&& visit) {
    visit("steps", steps, "steps over the channel length, even, at least 10");
    visit("flow_model", flow_model,
          "what the flow obeys: rectangle of the mean gap, or a flow model such as section-march");
    visit("inlet_profile", inlet_profile,
          "velocity profile at x = 0 of the models that march: developed or uniform");
    visit("exact_duct", exact_duct,
          "rectangle: side walls by the exact series of a duct, not by 1 - 0.63 h/w");
    visit("momentum_factor", momentum_factor,
          "rectangle: beta of the momentum flux, 1.2 = parabolic profile, 0 = creeping flow");
  }
  /// @throws InputError naming the option out of range, an unknown name (with the nearest known
  ///         one), or an option that the flow model does not heed.
  void validate() const;

  /// The flow model of that name; none: the rectangle.
  /// @throws InputError for an unknown name.
  std::optional<flow::FlowModel> model() const;
  /// @throws InputError for an unknown name.
  flow::InletProfile inlet() const;
};

/// Whether a model follows the velocity profile from the inlet on.
constexpr bool marches(flow::FlowModel model) {
  return model == flow::FlowModel::plane_march || model == flow::FlowModel::section_march;
}

}  // namespace manoscope::twin
