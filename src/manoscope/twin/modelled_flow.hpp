#pragma once

#include <optional>

#include "manoscope/core/arrays.hpp"
#include "manoscope/flow/flow_models.hpp"
#include "manoscope/flow/section_family.hpp"

namespace manoscope::twin {

/// What a flow model says at the same stations for one state of the wall after another. The table
/// of sections is kept as long as the deflections stay in it (flow::SectionFamily, 1e-8).
class ModelledFlow {
 public:
  /// @param flow  its deflections and outlet pressure are those of the calls.
  ModelledFlow(flow::FlowModel model, flow::FlowCase flow);

  flow::FlowModel model() const { return model_; }
  const flow::WallShape& shape() const { return flow_.shape; }

  /// As flow::pressure_along().
  /// @param zeta    (n) width-averaged deflection at the stations, m.
  /// @param outlet  Pa.
  flow::ModelledPressure pressure(const Array1& zeta, double outlet);
  /// The same at every other station, from the first on.
  flow::ModelledPressure coarse_pressure(const Array1& zeta, double outlet);

 private:
  /// Sections at the stations of a case, where the model takes any.
  flow::SectionsAlong sections(const flow::FlowCase& flow);

  flow::FlowModel model_;
  flow::FlowCase flow_;
  std::optional<flow::SectionFamily> family_;
};

}  // namespace manoscope::twin
