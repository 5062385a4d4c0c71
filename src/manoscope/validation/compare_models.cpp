#include "manoscope/validation/compare_models.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "manoscope/core/error.hpp"
#include "manoscope/flow/channel_resistance.hpp"
#include "manoscope/flow/laminar.hpp"
#include "manoscope/validation/error_table.hpp"

namespace manoscope::validation {
namespace {

constexpr double kLaminar = flow::kLargestLaminarReynolds;
constexpr double kFree = 0.05;  // of gap, viscosity and flow rate: far beyond any honest bar

bool marches_forward_only(flow::FlowModel model) {
  return flow::flow_model_info(model).needs_forward_flow;
}

/// "1.2 % more than" the wall's drop, by the larger of both.
std::string share_text(double part, double whole) {
  return fmt::format("{:.2g} %", std::abs(part) / std::abs(whole) * 100.0);
}

std::string verdict(const ModelAgreement& found, const Estimate& extracted,
                    const CompareModelsOptions& options, const char* who) {
  const double whole = extracted.value;
  const std::string expanded = share_text(kExpansion * found.uncertainty, whole);
  const std::string sides =
      fmt::format("the {} gives {} {} than the wall", who, share_text(found.difference, whole),
                  found.difference < 0.0 ? "less" : "more");
  const std::string along =
      fmt::format("along x p differs by more than its bars (chi-square {:.0f} of {:.0f})",
                  found.along.value, found.along.dof);
  std::string words;
  switch (found.agreement) {
    case Agreement::agree:
      words = fmt::format("agree within {}: {} (E_n {:.2f})", expanded, sides, found.en_number);
      break;
    case Agreement::drop_only:
      words = fmt::format("only the drop agrees, within {}: {} (E_n {:.2f}), but {}", expanded,
                          sides, found.en_number, along);
      break;
    case Agreement::differ:
      words = fmt::format("do not agree: {}, {:.1f} times the expanded uncertainty of {}", sides,
                          found.en_number, expanded);
      if (found.along.tail < options.along_tail) words += "; " + along;
      break;
    case Agreement::no_verdict:
      break;
  }
  if (!found.valid) {
    words += fmt::format("; at Re h/l = {:.2g} the model itself may be {:.2g} % off",
                         found.error.reduced_reynolds, found.error.half_width * 100.0);
  }
  if (found.separated) words += "; the march met backflow";
  return words;
}

class Comparison {
 public:
  Comparison(const FlowSetup& setup, FlowRate flow_rate, const Profile& state,
             const inversion::PressureReading& reading, const inversion::TestSection& section,
             const CompareModelsOptions& options)
      : setup_(setup), flow_rate_(flow_rate), state_(state), reading_(reading), options_(options) {
    line_ = wall_line(state, setup.channel.length);
    setup_.tables = tables_for(setup, line_.zeta);
    rise_ = inlet_rise(setup_, flow_case(setup_, flow_rate, line_));
    ends_ = Matrix::Zero(1, state.x.size());
    ends_(0, section.first) = 1.0;
    ends_(0, section.last) = -1.0;
    pieces_ = piece_weights(reading, state, section, options.pieces);
    first_ = section.first;
    last_ = section.last;
  }

  const WallLine& line() const { return line_; }
  const FlowSetup& setup() const { return setup_; }

  Estimate extracted() const {
    ErrorTable table(1);
    add_reading(table, 1.0, ends_, reading_, state_);
    return table.combine(reading_.pressure[first_] - reading_.pressure[last_], Array1::Ones(1));
  }

  /// Pressure on the line by a model, p = 0 at the outlet.
  Array1 pressure(flow::FlowModel model) const {
    return flow::pressure_along(model, flow_case(setup_, flow_rate_, line_), *setup_.tables)
        .pressure;
  }
  double section_drop(const Array1& pressure) const {
    return (on_line(ends_, line_) * pressure.matrix())(0);
  }
  double spread() const {
    return setup_.inlet_spread * std::abs(section_drop(rise_)) / std::sqrt(3.0);
  }

  ModelAgreement against(flow::FlowModel model, const Estimate& extracted) const {
    ModelledRun run = modelled_run(model, setup_, flow_rate_, line_, rise_);
    ModelAgreement found;
    found.model = model;
    found.pressure = run.pressure();
    found.error = run.error;
    found.valid = run.error.half_width <= options_.validity;
    found.separated = run.sensitivity.modelled.first_separated.has_value();
    if (!run.pressure().isFinite().all()) {
      found.drop.value = std::numeric_limits<double>::quiet_NaN();
      return without_verdict(found, "the march broke down");
    }
    ErrorTable own(1), both(1);
    add_model(own, 1.0, ends_, run, setup_, state_);
    found.drop = own.combine(section_drop(run.pressure()), Array1::Ones(1));
    found.difference = found.drop.value - extracted.value;
    // Another profile at the inlet moves the drop one way only: it excuses no difference the other.
    if (found.difference * section_drop(run.inlet_effect) > 0.0) run.inlet_effect.setZero();
    add_model(both, 1.0, ends_, run, setup_, state_);
    add_reading(both, -1.0, ends_, reading_, state_);
    found.uncertainty = std::sqrt(both.covariance()(0, 0));
    if (setup_.uncertainty.height == Length{}) {
      return without_verdict(found, "the gap has no stated uncertainty");
    }
    take_pieces(run, found);
    judge(found, extracted, options_);
    return found;
  }

 private:
  /// p(x) along x: with the bars as stated, and what is left once gap, fluid and pump are free.
  void take_pieces(const ModelledRun& run, ModelAgreement& found) const {
    const Array1 modelled = (on_line(pieces_, line_) * run.pressure().matrix()).array();
    const Array1 difference = modelled - (pieces_ * reading_.pressure.matrix()).array();
    const auto chi = [&](const FlowSetup& setup) {
      ErrorTable table(pieces_.rows());
      add_model(table, 1.0, pieces_, run, setup, state_);
      add_reading(table, -1.0, pieces_, reading_, state_);
      return chi_square(difference, table.covariance(), kResolution * std::abs(found.drop.value));
    };
    found.along = chi(setup_);
    FlowSetup free = setup_;
    const auto widen = [](double stated) { return std::hypot(stated, kFree); };
    FlowUncertainty& u = free.uncertainty;
    u.height = widen(u.height / setup_.channel.height) * setup_.channel.height;
    u.viscosity = widen(u.viscosity / setup_.fluid.viscosity) * setup_.fluid.viscosity;
    u.flow_rate = widen(u.flow_rate);
    found.log_likelihood = chi(free).log_likelihood;
  }

  static ModelAgreement without_verdict(ModelAgreement found, const char* reason) {
    found.en_number = std::numeric_limits<double>::quiet_NaN();
    found.agreement = Agreement::no_verdict;
    found.words = fmt::format("no verdict: {}", reason);
    return found;
  }

  FlowSetup setup_;
  FlowRate flow_rate_;
  const Profile& state_;
  const inversion::PressureReading& reading_;
  CompareModelsOptions options_;
  WallLine line_;
  Array1 rise_;
  Matrix ends_, pieces_;
  Index first_ = 0, last_ = 0;
};

std::vector<Correction> corrections(const Comparison& comparison, const FlowSetup& setup,
                                    FlowRate flow_rate, const std::vector<ModelAgreement>& models) {
  std::vector<Correction> terms;
  Array1 before = Array1::Zero(comparison.line().x.size());
  const auto add = [&](const char* name, const Array1& pressure,
                       std::optional<double> spread = std::nullopt) {
    const Array1 part = pressure - before;
    terms.push_back({name, Pressure::from_si(comparison.section_drop(part)),
                     Pressure::from_si(part[0] - part[part.size() - 1]),
                     spread ? std::optional(Pressure::from_si(*spread)) : std::nullopt});
    before = pressure;
  };
  add("mean-gap rectangle", comparison.pressure(flow::FlowModel::paper));
  add("true section", comparison.pressure(flow::FlowModel::creeping));
  add("inertia", comparison.pressure(flow::FlowModel::momentum));
  if (!(flow_rate.si() > 0.0)) return terms;
  const bool uniform = setup.inlet == flow::InletProfile::uniform;
  add("entry", uniform ? comparison.pressure(flow::FlowModel::developing) : before,
      comparison.spread());
  for (const ModelAgreement& found : models) {
    if (found.model == flow::FlowModel::section_march) add("section march", found.pressure);
  }
  return terms;
}

}  // namespace

void judge(ModelAgreement& found, const Estimate& extracted, const CompareModelsOptions& options,
           const char* who) {
  found.en_number = std::abs(found.difference) / (kExpansion * found.uncertainty);
  found.agreement = found.en_number > 1.0                   ? Agreement::differ
                    : found.along.tail < options.along_tail ? Agreement::drop_only
                                                            : Agreement::agree;
  found.words = verdict(found, extracted, options, who);
}

void CompareModelsOptions::validate() const {
  const auto refuse = [](const char* name, double value, const char* bound) {
    throw InputError(name, fmt::format("is {}", value), fmt::format("Give a number {}", bound));
  };
  if (pieces < 2) refuse("--pieces", pieces, "of 2 or more");
  if (!(validity > 0.0)) refuse("--validity", validity, "above 0");
  if (!(along_tail >= 0.0 && along_tail < 1.0)) refuse("--along-tail", along_tail, "in [0, 1)");
}

std::vector<flow::FlowModel> all_models() {
  std::vector<flow::FlowModel> models;
  for (const flow::FlowModelInfo& info : flow::kFlowModels) models.push_back(info.model);
  return models;
}

ModelComparison compare_models(const FlowSetup& setup, FlowRate flow_rate, const Profile& state,
                               const inversion::PressureReading& reading,
                               const inversion::TestSection& section,
                               const std::vector<flow::FlowModel>& models,
                               const CompareModelsOptions& options) {
  options.validate();
  if (!counts(reading, state, section.first) || !counts(reading, state, section.last)) {
    throw InputError("test section", "has no pressure at one of its ends",
                     "Let it begin and end where the wall answers");
  }
  const Comparison comparison(setup, flow_rate, state, reading, section, options);
  ModelComparison result;
  result.extracted = comparison.extracted();
  for (const flow::FlowModel model : models) {
    if (marches_forward_only(model) && !(flow_rate.si() > 0.0)) continue;
    result.models.push_back(comparison.against(model, result.extracted));
  }
  result.corrections = corrections(comparison, setup, flow_rate, result.models);
  result.line = comparison.line();
  result.reynolds = flow::local_reynolds(setup.channel, setup.fluid, flow_rate, result.line.zeta);
  result.reduced_reynolds =
      flow::reduced_reynolds(setup.channel, setup.fluid, flow_rate, result.line.zeta);
  result.laminar = result.reynolds.maxCoeff() < kLaminar;
  const flow::SectionsAlong sections =
      flow::sections_along(comparison.setup().tables->family, result.line.x, result.line.zeta);
  result.shear = flow::wall_shear(sections, setup.fluid, flow_rate);
  result.drag =
      flow::friction_drag(sections, setup.fluid, flow_rate, Length{}, setup.channel.length);
  result.relative_drag = flow::relative_drag(sections, setup.channel, setup.fluid, flow_rate,
                                             Length{}, setup.channel.length);
  return result;
}

}  // namespace manoscope::validation
