#include "manoscope/flow/model_error.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "manoscope/core/error.hpp"
#include "manoscope/flow/channel_resistance.hpp"

namespace manoscope::flow {
namespace {

constexpr double kLeast = 1e-4;          // of the sections and the quadrature
constexpr double kCorrelation = 0.024;   // R. K. Shah (1978)
constexpr double kSectionShare = 0.25;   // of the mean-gap rectangle, per zeta/(2 h0)
constexpr double kMomentumFactor = 1.2;  // beta of flow between plates

/// A value that rises in a straight line from `low` at x = from to `high` at x = to.
double ramp(double x, double from, double to, double low, double high) {
  return low + (high - low) * std::clamp((x - from) / (to - from), 0.0, 1.0);
}

/// Greatest error of p found, over inertia_share(): docs/flow-models.md.
double per_inertia(FlowModel model, double bulge) {
  switch (model) {
    case FlowModel::paper:  // what is left beside the section
    case FlowModel::creeping:
      return 1.5;
    case FlowModel::momentum:
    case FlowModel::developing:
      return 0.6;
    case FlowModel::energy:
      return 0.85;
    case FlowModel::plane_march:  // beneath a high roof the flow goes across as well
      return ramp(bulge, 0.25, 0.35, 0.15, 0.45);
    case FlowModel::section_march:
      return 0.015;
  }
  MANO_ASSERT(false);
  return 0.0;
}

}  // namespace

double reduced_reynolds(const Channel& channel, const Fluid& fluid, FlowRate flow_rate,
                        const Array1& zeta) {
  const double gap = channel.height.si() + zeta.mean();
  return std::abs(flow_rate.si()) / (channel.width.si() * fluid.kinematic_viscosity().si()) * gap /
         channel.length.si();
}

double inertia_share(const FlowCase& flow) {
  const Array1 area = flow.channel.width.si() * (flow.channel.height.si() + flow.zeta);
  const double momentum =
      0.5 * kMomentumFactor * flow.fluid.density.si() * std::pow(flow.flow_rate.si(), 2);
  const Array1 inverse = area.square().inverse();
  const double moved = momentum * (inverse - inverse[inverse.size() - 1]).abs().maxCoeff();
  const Array1 friction = running_resistance_drop(flow.channel, flow.fluid.viscosity,
                                                  flow.flow_rate, flow.x, flow.zeta);
  const double drop = std::abs(friction[friction.size() - 1] - friction[0]);
  return drop > 0.0 ? moved / drop : 0.0;
}

double ModelError::standard() const { return half_width / std::numbers::sqrt3; }

ModelError model_error(FlowModel model, const FlowCase& flow) {
  ModelError error;
  const Array1 bulge = flow.zeta.abs() / flow.channel.height.si();
  error.reduced_reynolds = reduced_reynolds(flow.channel, flow.fluid, flow.flow_rate, flow.zeta);
  error.half_width = std::max(kLeast, per_inertia(model, bulge.maxCoeff()) * inertia_share(flow));
  if (model == FlowModel::paper) error.half_width += kSectionShare * bulge.mean();
  if (model == FlowModel::developing) error.half_width += kCorrelation;
  return error;
}

}  // namespace manoscope::flow
