#include "manoscope/flow/flow_sensitivity.hpp"

#include <optional>

#include "manoscope/core/error.hpp"

namespace manoscope::flow {
namespace {

// Steps of the differences. The tables are good to 1e-8, so that a step of 1e-3 leaves 1e-5 of
// noise and a curvature of 1e-6 (central) or 2e-3 (forward, r goes as h^-3).
constexpr double kStep = 1e-3;

Index count(const FlowCase& flow) { return flow.x.size(); }

/// Sections of a case, or nothing where the model wants none.
SectionsAlong sections_of(FlowModel model, const FlowCase& flow, const SectionFamily& family) {
  if (!needs_sections(model)) return {};
  return sections_along(family, flow.x, flow.zeta);
}

void copy_section(const SectionsAlong& from, Index i, SectionsAlong& to) {
  to.area(i) = from.area(i);
  to.mean_gap(i) = from.mean_gap(i);
  to.conductance(i) = from.conductance(i);
  to.momentum_factor(i) = from.momentum_factor(i);
  to.energy_factor(i) = from.energy_factor(i);
  to.hydraulic_diameter(i) = from.hydraulic_diameter(i);
  to.roof_shear(i) = from.roof_shear(i);
  to.floor_shear(i) = from.floor_shear(i);
}

/// dp_i/d zeta_j by central differences, one station after the other.
Matrix by_zeta(FlowModel model, const FlowCase& flow, const SectionFamily* family) {
  const Index n = count(flow);
  const double step = kStep * flow.channel.height.si();
  FlowCase moved = flow;
  SectionsAlong here, up, down;
  if (family != nullptr) {
    here = sections_of(model, flow, *family);
    moved.zeta = flow.zeta + step;
    up = sections_of(model, moved, *family);
    moved.zeta = flow.zeta - step;
    down = sections_of(model, moved, *family);
    moved.zeta = flow.zeta;
  }
  Matrix slope(n, n);
  SectionsAlong sections = here;
  for (Index j = 0; j < n; ++j) {
    const auto at = [&](const SectionsAlong& from, double zeta) {
      moved.zeta(j) = zeta;
      if (family != nullptr) copy_section(from, j, sections);
      return pressure_along(model, moved, sections).pressure;
    };
    const Array1 above = at(up, flow.zeta(j) + step), below = at(down, flow.zeta(j) - step);
    slope.col(j) = ((above - below) / (2.0 * step)).matrix();
    moved.zeta(j) = flow.zeta(j);
    if (family != nullptr) copy_section(here, j, sections);
  }
  return slope;
}

bool marches(FlowModel model) {
  return model == FlowModel::plane_march || model == FlowModel::section_march;
}

FlowSensitivity sensitivity(FlowModel model, const FlowCase& flow, const SectionTables* tables) {
  const auto solve_by = [](FlowModel by, const FlowCase& one, const SectionFamily* family) {
    return pressure_along(by, one,
                          family == nullptr ? SectionsAlong{} : sections_of(by, one, *family));
  };
  const SectionFamily* const family = tables == nullptr ? nullptr : &tables->family;
  FlowSensitivity result;
  result.modelled = solve_by(model, flow, family);
  const Array1& pressure = result.modelled.pressure;
  const FlowModel local = marches(model) ? FlowModel::momentum : model;
  result.by_zeta = by_zeta(local, flow, family);
  // A march on sections costs as much as four in the plane, whose friction and inertia are nearly
  // the same.
  const FlowModel quick = model == FlowModel::section_march ? FlowModel::plane_march : model;
  const Array1 here = quick == model ? pressure : solve_by(quick, flow, family).pressure;

  FlowCase moved = flow;
  const double step = tables == nullptr ? kStep * flow.channel.height.si() : tables->step.si();
  moved.channel.height = flow.channel.height + Length::from_si(step);
  result.by_height =
      (solve_by(quick, moved, tables == nullptr ? nullptr : &tables->higher).pressure - here) /
      step;
  moved.channel.height = flow.channel.height;

  moved.flow_rate = (1.0 + kStep) * flow.flow_rate;
  const Array1 faster = solve_by(quick, moved, family).pressure;
  moved.flow_rate = (1.0 - kStep) * flow.flow_rate;
  result.by_flow_rate = (faster - solve_by(quick, moved, family).pressure) / (2.0 * kStep);
  result.by_viscosity = 2.0 * (pressure - flow.outlet_pressure.si()) - result.by_flow_rate;
  return result;
}

}  // namespace

SectionTables SectionTables::of(const Channel& channel, const WallShape& shape, Length least,
                                Length greatest) {
  channel.validate("table of sections");
  const Length step = kStep * channel.height;
  // Room for the differences in zeta, and for round-off.
  const Length low = least - 2.0 * step, high = greatest + 2.0 * step;
  Channel higher = channel;
  higher.height = channel.height + step;
  return {SectionFamily(channel, shape, low, high), SectionFamily(higher, shape, low, high), step};
}

FlowSensitivity flow_sensitivity(FlowModel model, const FlowCase& flow,
                                 const SectionTables& tables) {
  return sensitivity(model, flow, needs_sections(model) ? &tables : nullptr);
}

FlowSensitivity flow_sensitivity(FlowModel model, const FlowCase& flow) {
  if (!needs_sections(model)) return sensitivity(model, flow, nullptr);
  return flow_sensitivity(
      model, flow,
      SectionTables::of(flow.channel, flow.shape, Length::from_si(flow.zeta.minCoeff()),
                        Length::from_si(flow.zeta.maxCoeff())));
}

ModelledPressure pressure_along(FlowModel model, const FlowCase& flow,
                                const SectionTables& tables) {
  return pressure_along(model, flow, sections_of(model, flow, tables.family));
}

}  // namespace manoscope::flow
