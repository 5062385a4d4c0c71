#include "manoscope/twin/modelled_flow.hpp"

#include <utility>

namespace manoscope::twin {

ModelledFlow::ModelledFlow(flow::FlowModel model, flow::FlowCase flow)
    : model_(model), flow_(std::move(flow)) {}

flow::ModelledPressure ModelledFlow::pressure(const Array1& zeta, double outlet) {
  flow_.zeta = zeta;
  flow_.outlet_pressure = Pressure::from_si(outlet);
  return flow::pressure_along(model_, flow_, sections(flow_));
}

flow::ModelledPressure ModelledFlow::coarse_pressure(const Array1& zeta, double outlet) {
  flow::FlowCase coarse = flow_;
  const Index n = (flow_.x.size() + 1) / 2;
  coarse.x = flow_.x(Eigen::seqN(0, n, 2));
  coarse.zeta = zeta(Eigen::seqN(0, n, 2));
  coarse.outlet_pressure = Pressure::from_si(outlet);
  return flow::pressure_along(model_, coarse, sections(coarse));
}

flow::SectionsAlong ModelledFlow::sections(const flow::FlowCase& flow) {
  if (!flow::needs_sections(model_)) return {};
  if (!family_ || flow.zeta.minCoeff() < family_->least().si() ||
      flow.zeta.maxCoeff() > family_->greatest().si()) {
    family_ = flow::SectionFamily::of(flow.channel, flow.shape, flow.zeta);
  }
  return flow::sections_along(*family_, flow.x, flow.zeta);
}

}  // namespace manoscope::twin
