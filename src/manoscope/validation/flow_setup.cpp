#include "manoscope/validation/flow_setup.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "manoscope/core/error.hpp"
#include "manoscope/numerics/natural_spline.hpp"

namespace manoscope::validation {

FlowSetup with_tables(FlowSetup setup, Length least, Length greatest) {
  setup.tables = std::make_shared<const flow::SectionTables>(
      flow::SectionTables::of(setup.channel, setup.shape, least, greatest));
  return setup;
}

std::shared_ptr<const flow::SectionTables> tables_for(const FlowSetup& setup, const Array1& zeta) {
  if (setup.tables) return setup.tables;
  return with_tables(setup, Length::from_si(zeta.minCoeff()), Length::from_si(zeta.maxCoeff()))
      .tables;
}

WallLine wall_line(const Profile& state, Length length) {
  std::vector<double> x, zeta;
  WallLine line;
  const auto add = [&](double at, double deflection, Index station) {
    x.push_back(at);
    zeta.push_back(deflection);
    line.station.push_back(station);
  };
  const double l = length.si();
  for (Index ix = 0; ix < state.x.size(); ++ix) {
    const double at = state.x[ix];
    if (state.flags[ix] != 0 || at < 0.0 || at > l) continue;
    if (x.empty() && at > 0.0) add(0.0, 0.0, kClampedEnd);
    add(at, state.zeta[ix], ix);
  }
  if (x.empty()) add(0.0, 0.0, kClampedEnd);
  if (x.back() < l) add(l, 0.0, kClampedEnd);
  const auto n = static_cast<Index>(x.size());
  line.x = Eigen::Map<const Array1>(x.data(), n);
  line.zeta = Eigen::Map<const Array1>(zeta.data(), n);
  return line;
}

namespace {

constexpr Index kBridgeheads = 8;  // points on either side that a bridge goes through

/// Gives the stations between two neighbours of a line what a spline through the points around
/// says.
void bridge(const Profile& state, const WallLine& line, Index left, Profile& whole) {
  const Index first = std::max<Index>(0, left + 1 - kBridgeheads);
  const Index n = std::min<Index>(line.x.size(), left + 1 + kBridgeheads) - first;
  std::vector<Index> missing;
  for (Index ix = 0; ix < state.x.size(); ++ix) {
    if (state.x[ix] > line.x[left] && state.x[ix] < line.x[left + 1]) missing.push_back(ix);
  }
  if (missing.empty() || n < 4) return;
  const auto m = static_cast<Index>(missing.size());
  Array1 at(m);
  for (Index k = 0; k < m; ++k) at[k] = state.x[missing[static_cast<std::size_t>(k)]];
  const Matrix weights = numerics::NaturalSpline(line.x.segment(first, n)).sampling(at);
  const auto carry = [&](const Matrix& by, const Array1& values, Array1& into) {
    Array1 known = Array1::Zero(n);  // 0 at the clamped ends
    for (Index i = 0; i < n; ++i) {
      const Index ix = line.station[static_cast<std::size_t>(first + i)];
      if (ix != kClampedEnd) known[i] = values[ix];
    }
    const Array1 carried = (by * known.matrix()).array();
    for (Index k = 0; k < m; ++k) into[missing[static_cast<std::size_t>(k)]] = carried[k];
  };
  carry(weights, state.zeta, whole.zeta);
  for (std::size_t k = 0; k < state.uncertainty.modes.size(); ++k) {
    carry(weights, state.uncertainty.modes[k].effect, whole.uncertainty.modes[k].effect);
  }
  Array1& noise = whole.uncertainty.independent;
  carry(weights.cwiseAbs2(), state.uncertainty.independent.square(), noise);
  for (const Index ix : missing) {
    noise[ix] = std::sqrt(noise[ix]);
    whole.flags[ix] = 0;
  }
}

}  // namespace

Profile bridged(const Profile& state, Length length, Length longest) {
  const WallLine line = wall_line(state, length);
  Profile whole = state;
  for (Index i = 0; i + 1 < line.x.size(); ++i) {
    if (line.x[i + 1] - line.x[i] <= longest.si()) bridge(state, line, i, whole);
  }
  return whole;
}

flow::FlowCase flow_case(const FlowSetup& setup, FlowRate flow_rate, const WallLine& line) {
  flow::FlowCase flow;
  flow.channel = setup.channel;
  flow.fluid = setup.fluid;
  flow.flow_rate = flow_rate;
  flow.x = line.x;
  flow.zeta = line.zeta;
  flow.shape = setup.shape;
  flow.inlet = setup.inlet;
  flow.developing_length = setup.developing_length;
  return flow;
}

Array1 inlet_rise(const FlowSetup& setup, const flow::FlowCase& flow) {
  if (!(setup.inlet_spread >= 0.0 && setup.inlet_spread <= 1.0)) {
    throw InputError("inlet spread", fmt::format("is {}", setup.inlet_spread),
                     "Give 0 for a known profile, up to 1 for one between developed and uniform");
  }
  const bool known = setup.inlet_spread == 0.0 && setup.inlet == flow::InletProfile::developed;
  if (known || !(flow.flow_rate.si() > 0.0)) return Array1::Zero(flow.x.size());
  const auto tables = tables_for(setup, flow.zeta);
  flow::FlowCase other = flow;
  for (const flow::FlowModel march :
       {flow::FlowModel::section_march, flow::FlowModel::plane_march}) {
    const auto solve = [&](flow::InletProfile inlet) {
      other.inlet = inlet;
      return flow::pressure_along(march, other, *tables).pressure;
    };
    Array1 rise = solve(flow::InletProfile::uniform) - solve(flow::InletProfile::developed);
    if (rise.isFinite().all()) return rise;
  }
  throw InputError("inlet spread", "the march from a uniform or a developed profile broke down",
                   "Smooth the deflection, or state the inlet profile as developed with a spread "
                   "of 0");
}

namespace {

/// Whether a model starts from FlowCase::inlet; the others know developed flow alone.
bool takes_inlet(flow::FlowModel model) {
  return model == flow::FlowModel::plane_march || model == flow::FlowModel::section_march;
}

/// What of the rise from a developed to a uniform profile a model may lack, -1 to 1.
double lacking_rise(flow::FlowModel model, const FlowSetup& setup) {
  if (model == flow::FlowModel::developing) return -setup.inlet_spread;
  const bool uniform = setup.inlet == flow::InletProfile::uniform;
  if (takes_inlet(model)) return uniform ? -setup.inlet_spread : setup.inlet_spread;
  return uniform ? 1.0 : setup.inlet_spread;
}

}  // namespace

ModelledRun modelled_run(flow::FlowModel model, const FlowSetup& setup, FlowRate flow_rate,
                         const WallLine& line) {
  return modelled_run(model, setup, flow_rate, line,
                      inlet_rise(setup, flow_case(setup, flow_rate, line)));
}

ModelledRun modelled_run(flow::FlowModel model, const FlowSetup& setup, FlowRate flow_rate,
                         const WallLine& line, const Array1& inlet_rise) {
  const flow::FlowCase flow = flow_case(setup, flow_rate, line);
  ModelledRun run;
  run.line = line;
  if (flow::needs_sections(model)) {
    run.sensitivity = flow::flow_sensitivity(model, flow, *tables_for(setup, line.zeta));
  } else {
    run.sensitivity = flow::flow_sensitivity(model, flow);
  }
  run.error = flow::model_error(model, flow);
  // About the end of a rectangular distribution the mean square is a third of its width squared.
  run.inlet_effect = lacking_rise(model, setup) / std::numbers::sqrt3 * inlet_rise;
  return run;
}

}  // namespace manoscope::validation
