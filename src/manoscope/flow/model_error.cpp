#include "manoscope/flow/model_error.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "manoscope/core/error.hpp"

namespace manoscope::flow {
namespace {

constexpr double kSlow = 0.6, kFast = 8.0;  // Re h/l of the reference flows
constexpr double kLeast = 1e-4;             // of the sections and the quadrature
constexpr double kCorrelation = 0.024;      // R. K. Shah (1978)
constexpr double kSectionShare = 0.25;      // of the mean-gap rectangle, per zeta/(2 h0)

struct ReferenceErrors {
  double slow, fast;
};

/// Greatest errors of p on the 3-D reference flows, those of kFlowModels.
ReferenceErrors reference_errors(FlowModel model) {
  switch (model) {
    case FlowModel::paper:  // what is left beside the section
    case FlowModel::creeping:
      return {0.012, 0.124};
    case FlowModel::momentum:
    case FlowModel::developing:
      return {0.003, 0.055};
    case FlowModel::energy:
      return {0.0006, 0.086};
    case FlowModel::plane_march:
      return {0.0007, 0.006};
    case FlowModel::section_march:
      return {0.00015, 0.002};
  }
  MANO_ASSERT(false);
  return {};
}

}  // namespace

double reduced_reynolds(const Channel& channel, const Fluid& fluid, FlowRate flow_rate,
                        const Array1& zeta) {
  const double gap = channel.height.si() + zeta.mean();
  return std::abs(flow_rate.si()) / (channel.width.si() * fluid.kinematic_viscosity().si()) * gap /
         channel.length.si();
}

double ModelError::standard() const { return half_width / std::numbers::sqrt3; }

ModelError model_error(FlowModel model, const FlowCase& flow) {
  ModelError error;
  error.reduced_reynolds = reduced_reynolds(flow.channel, flow.fluid, flow.flow_rate, flow.zeta);
  const ReferenceErrors found = reference_errors(model);
  const double power = std::log(found.fast / found.slow) / std::log(kFast / kSlow);
  error.half_width = std::max(kLeast, found.slow * std::pow(error.reduced_reynolds / kSlow, power));
  if (model == FlowModel::paper) {
    error.half_width += kSectionShare * flow.zeta.abs().mean() / flow.channel.height.si();
  }
  if (model == FlowModel::developing) error.half_width += kCorrelation;
  return error;
}

}  // namespace manoscope::flow
