#include "manoscope/flow/flow_sensitivity.hpp"

#include <gtest/gtest.h>

#include "manoscope/core/error.hpp"
#include "manoscope/flow/channel_resistance.hpp"

namespace manoscope::flow {
namespace {

constexpr Index kStations = 41;

FlowCase bulged(FlowRate flow_rate) {
  FlowCase flow;
  flow.channel = {15.5 * mm, 1.7 * mm, 175.0 * um};
  flow.fluid = {1.0 * mPa_s, 998.0 * kg_per_m3};
  flow.flow_rate = flow_rate;
  flow.x = Array1::LinSpaced(kStations, 0.0, 15.5e-3);
  const Array1 s = flow.x / 15.5e-3;
  flow.zeta =
      60e-6 * (1.0 - 0.8 * s) * (1.0 - (-s * 12.0).exp()) * (1.0 - (-(1.0 - s) * 12.0).exp());
  flow.outlet_pressure = 300.0 * Pa;
  return flow;
}

/// Smooth change of the gap, m.
Array1 change(const FlowCase& flow) { return 1e-6 * (1.0 + flow.x / 15.5e-3); }

SectionTables tables_of(const FlowCase& flow) {
  return SectionTables::of(flow.channel, flow.shape, Length::from_si(-2e-6), 62.0 * um);
}

TEST(FlowSensitivity, OfThePaperMatchesItsOwnAnalyticGradient) {
  const FlowCase flow = bulged(5.0 * mL_per_min);
  const FlowSensitivity found = flow_sensitivity(FlowModel::paper, flow);
  const ResistanceDrop exact = resistance_drop(flow.channel, flow.fluid.viscosity, flow.flow_rate,
                                               flow.x, flow.zeta, Length{}, flow.channel.length);
  const Array1 drop = found.by_zeta.row(0).transpose().array();
  // Central differences at h 1e-3: the third derivative of h^-3 leaves 60/6 * 1e-6 = 1e-5.
  EXPECT_LT((drop - exact.zeta_gradient).abs().maxCoeff(),
            2e-5 * exact.zeta_gradient.abs().maxCoeff());
  // Forward in the height: second derivative, 12/2/3 * 1e-3 of the first.
  EXPECT_NEAR(found.by_height(0) / exact.height_gradient, 1.0, 3e-3);
  EXPECT_NEAR(found.by_flow_rate(0) / exact.drop.si(), 1.0, 1e-9);  // linear: round-off
  EXPECT_NEAR(found.by_viscosity(0) / exact.drop.si(), 1.0, 1e-9);
}

TEST(FlowSensitivity, MatchesAChangeOfAllStationsTogether) {
  const FlowCase flow = bulged(40.0 * mL_per_min);
  const SectionTables tables = tables_of(flow);
  for (const FlowModel model :
       {FlowModel::creeping, FlowModel::momentum, FlowModel::energy, FlowModel::developing}) {
    const FlowSensitivity found = flow_sensitivity(model, flow, tables);
    FlowCase up = flow, down = flow;
    const Array1 step = 0.05 * change(flow);
    up.zeta += step;
    down.zeta -= step;
    const Array1 whole = 0.5 * (pressure_along(model, up, tables).pressure -
                                pressure_along(model, down, tables).pressure);
    const Array1 summed = (found.by_zeta * step.matrix()).array();
    // 1e-3: what the docstring states.
    EXPECT_LT((summed - whole).abs().maxCoeff(), 1e-3 * whole.abs().maxCoeff())
        << flow_model_info(model).name;
  }
}

TEST(FlowSensitivity, OfViscosityIsThatOfAnotherFluid) {
  const FlowCase flow = bulged(40.0 * mL_per_min);
  const SectionTables tables = tables_of(flow);
  for (const FlowModel model : {FlowModel::momentum, FlowModel::plane_march}) {
    const FlowSensitivity found = flow_sensitivity(model, flow, tables);
    FlowCase thick = flow, thin = flow;
    thick.fluid.viscosity = 1.001 * flow.fluid.viscosity;
    thin.fluid.viscosity = 0.999 * flow.fluid.viscosity;
    const Array1 change = (pressure_along(model, thick, tables).pressure -
                           pressure_along(model, thin, tables).pressure) /
                          0.002;
    // Differences of 1e-3 on both sides: 1e-6 each, and the march's own round-off.
    EXPECT_LT((found.by_viscosity - change).abs().maxCoeff(), 1e-4 * change.abs().maxCoeff())
        << flow_model_info(model).name;
  }
}

TEST(FlowSensitivity, OfTheMarchesToTheGapIsGoodEnoughForAnErrorBar) {
  const FlowCase flow = bulged(40.0 * mL_per_min);  // Re h/l = 5, inertia a third of friction
  const SectionTables tables = tables_of(flow);
  const FlowSensitivity found = flow_sensitivity(FlowModel::plane_march, flow, tables);
  FlowCase up = flow;
  up.zeta += change(flow);
  const Array1 whole =
      pressure_along(FlowModel::plane_march, up, tables).pressure - found.modelled.pressure;
  const Array1 summed = (found.by_zeta * change(flow).matrix()).array();
  // A tenth or two, as the docstring says: an error bar that is off by that covers 92 to 98 %.
  EXPECT_LT((summed - whole).abs().maxCoeff(), 0.2 * whole.abs().maxCoeff());
}

TEST(FlowSensitivity, OfTheSectionMarchIsNearlyItsOwn) {
  const FlowCase flow = bulged(40.0 * mL_per_min);
  const SectionTables tables = tables_of(flow);
  const FlowSensitivity found = flow_sensitivity(FlowModel::section_march, flow, tables);
  FlowCase moved = flow;
  moved.flow_rate = 1.01 * flow.flow_rate;
  const Array1 by_flow_rate =
      (pressure_along(FlowModel::section_march, moved, tables).pressure - found.modelled.pressure) /
      0.01;
  // 2 %, as the docstring says; 0.5 % of it is the curvature of this forward difference.
  EXPECT_LT((found.by_flow_rate - by_flow_rate).abs().maxCoeff(),
            0.02 * by_flow_rate.abs().maxCoeff());
  moved = flow;
  moved.channel.height = 1.005 * flow.channel.height;
  const Array1 by_height =
      (pressure_along(FlowModel::section_march, moved).pressure - found.modelled.pressure) /
      (0.005 * flow.channel.height.si());
  EXPECT_LT((found.by_height - by_height).abs().maxCoeff(), 0.02 * by_height.abs().maxCoeff());
}

TEST(FlowSensitivity, RefusesDeflectionsOutsideItsTables) {
  FlowCase flow = bulged(5.0 * mL_per_min);
  const SectionTables tables = SectionTables::of(flow.channel, flow.shape, Length{}, 20.0 * um);
  EXPECT_THROW(flow_sensitivity(FlowModel::creeping, flow, tables), InputError);
}

}  // namespace
}  // namespace manoscope::flow
