#include "manoscope/pipeline/flow_knowledge.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "manoscope/core/error.hpp"
#include "manoscope/flow/entry_flow.hpp"
#include "manoscope/inversion/thinned.hpp"
#include "manoscope/validation/wall_answer.hpp"

namespace manoscope::pipeline {
namespace {

using experiment::Experiment;

constexpr int kShapeTerms = 3;  // a plate strip has two, a membrane one

flow::PressureTerm named(const char* passage, flow::PressureTerm term) {
  term.name = fmt::format("{}, {}", passage, term.name);
  return term;
}

flow::RigidPassage sizes(const experiment::Passage& passage) {
  return {passage.length, passage.width, passage.height,
          passage.height_uncertainty.value_or(Length{})};
}

/// Backwards or at rest the fittings have no formula; the duct has.
flow::PressureTerm duct_alone(const flow::Fluid& fluid, FlowRate flow_rate,
                              const flow::RigidPassage& passage) {
  flow::PressureTerm duct;
  duct.name = duct.formula = "duct";
  duct.source = "exact series";
  duct.drop = flow::passage_drop(fluid.viscosity, flow_rate, passage);
  duct.by_flow_rate = duct.by_viscosity = duct.drop;
  duct.height_effect = -3.0 * (passage.height_uncertainty / passage.height) * duct.drop;
  return duct;
}

std::vector<flow::PressureTerm> passage_parts(const Experiment& experiment, const char* name,
                                              const experiment::Passage& passage,
                                              FlowRate flow_rate) {
  const flow::Fluid fluid = fluid_of(experiment);
  std::vector<flow::PressureTerm> parts;
  if (flow_rate > FlowRate{}) {
    parts = flow::passage_terms(fluid, flow_rate, sizes(passage), passage.fittings);
  } else {
    parts.push_back(duct_alone(fluid, flow_rate, sizes(passage)));
  }
  for (flow::PressureTerm& part : parts) part = named(name, part);
  return parts;
}

/// About n of the stations inside the channel, five times as dense at its ends as in the middle:
/// there the wall rises within a length like the width.
std::vector<Index> graded_stations(const Array1& x, const flow::Channel& channel, Index n) {
  constexpr double kDenser = 4.0;
  const double l = channel.length.si(), w = channel.width.si();
  const auto place = [&](double at) {  // integral of 1 + kDenser (exp(-x/w) + exp(-(l - x)/w))
    return at + kDenser * w * (1.0 - std::exp(-at / w) + std::exp((at - l) / w) - std::exp(-l / w));
  };
  const double step = place(l) / static_cast<double>(n);
  std::vector<Index> stations;
  double next = 0.0;
  for (Index ix = 0; ix < x.size(); ++ix) {
    if (x[ix] < 0.0 || x[ix] > l || place(x[ix]) < next) continue;
    stations.push_back(ix);
    next = place(x[ix]) + 0.999 * step;
  }
  return stations;
}

std::string inlet_words(const Experiment& experiment) {
  const experiment::InletSection& inlet = experiment.inlet;
  const char* const profile =
      inlet.profile == flow::InletProfile::developed ? "developed" : "uniform";
  const char* const other =
      inlet.profile == flow::InletProfile::developed ? "uniform" : "developed";
  if (!inlet.spread && experiment.rigid.inlet) {
    return fmt::format("{} where it enters, as far as rigid.inlet lets it develop", profile);
  }
  const double spread = inlet.spread.value_or(1.0);
  if (spread == 0.0) return fmt::format("{} where it enters", profile);
  return fmt::format("{} where it enters, or up to {:.0f} % of the way to {}{}", profile,
                     100.0 * spread, other,
                     inlet.spread ? "" : " (inlet.spread would narrow that)");
}

}  // namespace

flow::Channel channel_of(const Experiment& experiment) {
  return {experiment.channel.length, experiment.channel.width, experiment.channel.height};
}

flow::Fluid fluid_of(const Experiment& experiment) {
  return {experiment.fluid.viscosity, experiment.fluid.density};
}

inversion::GaugeErrors gauge_of(const Experiment& experiment) {
  return {experiment.instrument.pressure_gain_uncertainty.value_or(0.0),
          experiment.instrument.pressure_zero_uncertainty.value_or(Pressure{})};
}

validation::FlowUncertainty flow_uncertainty_of(const Experiment& experiment) {
  return {experiment.channel.height_uncertainty.value_or(Length{}),
          experiment.fluid.viscosity_uncertainty.value_or(Viscosity{}),
          experiment.instrument.flow_rate_uncertainty.value_or(0.0)};
}

flow::PassageUncertainty passage_uncertainty_of(const Experiment& experiment) {
  const validation::FlowUncertainty flowing = flow_uncertainty_of(experiment);
  return {flowing.flow_rate, flowing.viscosity / experiment.fluid.viscosity};
}

std::optional<flow::WallShape> shape_across(const maps::ResponsePicture& response,
                                            const flow::Channel& channel) {
  const double quarter = 0.25 * channel.length.si(), half_width = 0.5 * channel.width.si();
  std::vector<double> s, zeta;
  for (Index iz = 0; iz < response.z.size(); ++iz) {
    const double at = response.z[iz] / half_width;
    if (std::abs(at) > 1.0) continue;
    double sum = 0.0, count = 0.0;
    for (Index ix = 0; ix < response.x.size(); ++ix) {
      if (response.x[ix] < quarter || response.x[ix] > 3.0 * quarter) continue;
      if (std::isnan(response.height(iz, ix))) continue;
      sum += response.height(iz, ix);
      count += 1.0;
    }
    if (count == 0.0) continue;
    s.push_back(at);
    zeta.push_back(sum / count);
  }
  const auto n = static_cast<Index>(s.size());
  if (n < 2 * kShapeTerms) return std::nullopt;
  const Eigen::Map<const Array1> deflection(zeta.data(), n);
  const double mean = deflection.mean();
  // A wall that answers with its mean has the same sign nearly everywhere.
  if (std::abs(mean) < 0.2 * deflection.abs().maxCoeff()) return std::nullopt;
  try {
    return flow::WallShape::fit(Eigen::Map<const Array1>(s.data(), n), deflection, kShapeTerms);
  } catch (const InputError&) {
    return std::nullopt;
  }
}

FlowKnowledge know_flow(const Experiment& experiment, const ReducedExperiment& reduced,
                        const calibration::ConstitutiveCurves& curves,
                        const std::vector<FlowRun>& runs, Index n_stations,
                        double largest_extrapolation) {
  FlowKnowledge known;
  known.setup.channel = channel_of(experiment);
  known.setup.fluid = fluid_of(experiment);
  known.setup.uncertainty = flow_uncertainty_of(experiment);
  known.setup.inlet = experiment.inlet.profile;
  known.setup.developing_length = experiment.inlet.developing_length;
  const auto shape = shape_across(reduced.response, known.setup.channel);
  known.setup.shape = shape.value_or(flow::WallShape::parabola());
  known.words = fmt::format(
      "section of the wall between lowest and highest level: crest {:.3g} times the mean{}; flow "
      "{}",
      known.setup.shape.crest(), shape ? "" : " (a parabola, since the maps do not show it)",
      inlet_words(experiment));

  known.stations = graded_stations(curves.x, known.setup.channel, n_stations);
  known.curves = inversion::thinned(curves, known.stations);
  const validation::CurvedWall wall(known.curves, experiment.channel.length, largest_extrapolation);
  double least = wall.least(), greatest = wall.greatest();
  for (const FlowRun& run : runs) {
    for (Index ix = 0; ix < run.profile.x.size(); ++ix) {
      if (run.profile.flags[ix] != 0) continue;
      least = std::min(least, run.profile.zeta[ix]);
      greatest = std::max(greatest, run.profile.zeta[ix]);
    }
  }
  known.setup =
      validation::with_tables(known.setup, Length::from_si(least), Length::from_si(greatest));
  return known;
}

double inlet_spread(const Experiment& experiment, FlowRate flow_rate) {
  if (experiment.inlet.spread) return *experiment.inlet.spread;
  if (!experiment.rigid.inlet || !(flow_rate > FlowRate{})) return 1.0;
  const experiment::Passage& passage = *experiment.rigid.inlet;
  const double w = passage.width.si(), h = passage.height.si();
  const double diameter = 2.0 * w * h / (w + h);
  const double reynolds =
      flow_rate.si() / (w * h) * diameter / fluid_of(experiment).kinematic_viscosity().si();
  const flow::EntryConstants constants = flow::entry_constants(h / w);
  const double developed =
      flow::entry_excess(constants, passage.length.si() / (diameter * reynolds)) /
      constants.incremental_drop;
  return std::clamp(1.0 - developed, 0.0, 1.0);
}

std::vector<flow::PressureTerm> passages(const Experiment& experiment, FlowRate flow_rate) {
  const experiment::RigidSection& rigid = experiment.rigid;
  if (!rigid.simulated.empty()) return {flow::simulated_drop(rigid.simulated, flow_rate)};
  std::vector<flow::PressureTerm> parts;
  const auto add = [&](const char* name, const std::optional<experiment::Passage>& passage) {
    if (!passage) return;
    for (auto& part : passage_parts(experiment, name, *passage, flow_rate)) {
      parts.push_back(std::move(part));
    }
  };
  add("inlet", rigid.inlet);
  add("outlet", rigid.outlet);
  return parts;
}

validation::Outlet behind_passage(const Experiment& experiment, FlowRate flow_rate,
                                  Pressure gauge) {
  if (!experiment.rigid.outlet) return {gauge, {}};
  const Estimate drop = flow::parasitic_estimate(
      passage_parts(experiment, "outlet", *experiment.rigid.outlet, flow_rate),
      passage_uncertainty_of(experiment));
  return {gauge + Pressure::from_si(drop.value), Pressure::from_si(drop.standard_uncertainty())};
}

validation::Outlet outlet_of(const Experiment& experiment, const FlowKnowledge& knowledge,
                             const FlowRun& run, const inversion::PressureReading& reading,
                             const std::optional<inversion::TestSection>& section) {
  // Within a width of the outlet the profile is the end layer's, not the model's.
  constexpr double kDoubt = 0.1;
  if (run.outlet_pressure) {
    return behind_passage(experiment, run.flow_rate, *run.outlet_pressure);
  }
  const Array1 bars = reading.uncertainty.standard();
  const auto read = [&](Index ix) {
    return validation::Outlet{Pressure::from_si(reading.pressure[ix]), Pressure::from_si(bars[ix])};
  };
  if (!section) {
    for (Index ix = reading.x.size(); ix-- > 0;) {
      if (reading.answered(ix)) return read(ix);
    }
    return {};
  }
  validation::Outlet outlet = read(section->last);
  const validation::WallLine line =
      validation::wall_line(run.profile, knowledge.setup.channel.length);
  const Array1 fall =
      flow::pressure_along(flow::FlowModel::momentum,
                           flow_case(knowledge.setup, run.flow_rate, line), *knowledge.setup.tables)
          .pressure;
  for (Index i = 0; i < line.x.size(); ++i) {
    if (line.station[static_cast<std::size_t>(i)] != section->last) continue;
    outlet.pressure -= Pressure::from_si(fall[i]);
    outlet.uncertainty =
        Pressure::from_si(std::hypot(outlet.uncertainty.si(), kDoubt * std::abs(fall[i])));
  }
  return outlet;
}

}  // namespace manoscope::pipeline
