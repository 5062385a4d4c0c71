#include "manoscope/flow/flow_models.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <vector>

#include "manoscope/core/error.hpp"
#include "manoscope/core/suggest.hpp"
#include "manoscope/flow/entry_flow.hpp"
#include "manoscope/flow/one_dimensional.hpp"
#include "manoscope/flow/plane_march.hpp"
#include "manoscope/flow/section_family.hpp"
#include "manoscope/flow/section_flow.hpp"
#include "manoscope/flow/section_march.hpp"

namespace manoscope::flow {
namespace {

/// Length between the last station and the outlet, m.
double rest_to_outlet(const FlowCase& flow) {
  const Index last = flow.x.size() - 1;
  const double rest = flow.channel.length.si() - flow.x(last);
  const double spacing = flow.x(last) - flow.x(last - 1);
  // A relative 1e-9 of slack: stations and length come from different round-offs.
  if (rest >= -1e-9 * spacing && rest <= spacing * (1.0 + 1e-9)) return rest;
  throw InputError("flow model",
                   fmt::format("the last station is at x = {:.6g} mm in a channel {:.6g} mm long",
                               flow.x(last) * 1e3, flow.channel.length.in(mm)),
                   "Give stations up to the outlet, at most one spacing from it");
}

void check(const FlowModelInfo& info, const FlowCase& flow) {
  flow.channel.validate("flow model");
  flow.fluid.validate("flow model");
  if (flow.x.size() < 3 || flow.zeta.size() != flow.x.size()) {
    throw InputError("flow model",
                     fmt::format("{} deflections at {} stations", flow.zeta.size(), flow.x.size()),
                     "Give one deflection a station, at three stations or more");
  }
  if (!info.needs_forward_flow || flow.flow_rate.si() > 0.0) return;
  throw InputError("flow model",
                   fmt::format("the flow rate is {:g} mL/min for the model \"{}\"",
                               flow.flow_rate.in(mL_per_min), info.name),
                   "Give a positive flow rate, with x along the flow");
}

}  // namespace

const FlowModelInfo& flow_model_info(FlowModel model) {
  const auto index = static_cast<std::size_t>(model);
  MANO_ASSERT(index < kFlowModels.size() && kFlowModels[index].model == model);
  return kFlowModels[index];
}

FlowModel flow_model(std::string_view name) {
  std::vector<std::string> names;
  for (const FlowModelInfo& info : kFlowModels) {
    if (info.name == name) return info.model;
    names.emplace_back(info.name);
  }
  throw InputError("flow model",
                   fmt::format("\"{}\" is no flow model{}", name, did_you_mean(name, names)),
                   fmt::format("Give one of {}", fmt::join(names, ", ")));
}

ModelledPressure pressure_along(FlowModel model, const FlowCase& flow) {
  check(flow_model_info(model), flow);
  if (!needs_sections(model)) return pressure_along(model, flow, SectionsAlong{});
  const SectionFamily family = SectionFamily::of(flow.channel, flow.shape, flow.zeta);
  return pressure_along(model, flow, sections_along(family, flow.x, flow.zeta));
}

ModelledPressure pressure_along(FlowModel model, const FlowCase& flow,
                                const SectionsAlong& sections) {
  check(flow_model_info(model), flow);
  const double rest = rest_to_outlet(flow);
  const Index n = flow.x.size();
  ModelledPressure result{model, Array1::Zero(n), Flags1::Zero(n), {}};
  if (model == FlowModel::paper) {
    OneDimensionalOptions options;
    options.exact_duct = false;
    result.pressure = one_dimensional_pressure(flow.channel, flow.fluid, flow.flow_rate, flow.x,
                                               flow.zeta, flow.outlet_pressure, options);
    return result;
  }
  MANO_ASSERT(sections.x.size() == n);
  const double last_resistance = flow.fluid.viscosity.si() / sections.conductance(n - 1);
  const double outlet = flow.outlet_pressure.si() + rest * last_resistance * flow.flow_rate.si();
  const auto from_drop = [&](const Array1& drop) {
    result.pressure = outlet + (drop(n - 1) - drop);
  };
  const auto friction = [&] { return friction_drop(sections, flow.fluid, flow.flow_rate); };
  switch (model) {
    case FlowModel::paper:
      break;
    case FlowModel::creeping:
      from_drop(friction());
      break;
    case FlowModel::momentum:
      from_drop(friction() + momentum_drop(sections, flow.fluid, flow.flow_rate));
      break;
    case FlowModel::energy:
      from_drop(friction() + energy_drop(sections, flow.fluid, flow.flow_rate));
      break;
    case FlowModel::developing:
      from_drop(friction() + momentum_drop(sections, flow.fluid, flow.flow_rate) +
                entry_drop(sections, flow.fluid, flow.flow_rate, flow.channel.width,
                           flow.developing_length));
      break;
    case FlowModel::plane_march: {
      PlaneMarchOptions options;
      options.inlet = flow.inlet;
      const Array1 factor =
          12.0 * sections.conductance / (sections.area * sections.mean_gap.square());
      const PlaneMarch march =
          march_plane(flow.x, sections.mean_gap, factor,
                      flow.flow_rate.si() / flow.channel.width.si(), flow.fluid, options);
      result.pressure = outlet + march.pressure;
      result.flags = march.flags;
      result.first_separated = march.first_separated;
      break;
    }
    case FlowModel::section_march: {
      SectionMarchOptions options;
      options.inlet = flow.inlet;
      const SectionMarch march = march_section(flow.channel, flow.shape, flow.fluid, flow.flow_rate,
                                               flow.x, flow.zeta, options);
      result.pressure = outlet + march.roof_pressure;
      result.flags = march.flags;
      result.first_separated = march.first_separated;
      break;
    }
  }
  return result;
}

}  // namespace manoscope::flow
