#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string_view>
#include <utility>

#include "manoscope/pipeline/predict.hpp"

namespace manoscope::pipeline {
namespace {

/// What would mend a source of uncertainty.
std::string_view mend(std::string_view source) {
  static constexpr std::array<std::pair<std::string_view, std::string_view>, 6> kMends{{
      {"inlet profile", "state how far it is known, profile and spread under [inlet]"},
      {"channel height", "measure the gap better, channel.height_uncertainty"},
      {"viscosity", "know it better, fluid.viscosity_uncertainty"},
      {"flow rate", "know it better, instrument.flow_rate_uncertainty"},
      {"outlet pressure", "give it with --outlet-pressure and --outlet-uncertainty"},
      {"flow model", "take one that states a smaller error here, --model"},
  }};
  for (const auto& [name, words] : kMends) {
    if (name == source) return words;
  }
  return "calibrate with more levels or a better gauge";
}

/// Variance of an estimate by source: terms of one variable are one error.
std::map<std::string, double> variance_by_source(const Estimate& estimate) {
  std::map<std::pair<std::string, std::string>, double> effect;
  for (const Estimate::Term& term : estimate.terms) {
    effect[{term.source, term.variable}] += term.effect;
  }
  std::map<std::string, double> variance;
  for (const auto& [name, size] : effect) variance[name.first] += size * size;
  return variance;
}

bool beyond_calibration(const validation::FlowPrediction& flow) {
  for (Index i = 0; i < flow.flags.size(); ++i) {
    if ((flow.flags[i] & validation::PredictionFlag::out_of_calibration) != 0) return true;
  }
  return false;
}

}  // namespace

std::string doubt_prediction(const validation::FlowPrediction& flow) {
  constexpr double kLargest = 0.25;
  const double drop = std::abs(flow.drop.value);
  const double expanded = kExpansion * flow.drop.standard_uncertainty();
  if (!(expanded > kLargest * drop)) return {};
  const auto variance = variance_by_source(flow.drop);
  double all = 0.0;
  for (const auto& [source, part] : variance) all += part;
  const auto most = std::max_element(
      variance.begin(), variance.end(),
      [](const auto& one, const auto& other) { return one.second < other.second; });
  return fmt::format(
      "At {:.4g} mL/min U is {:.0f} % of the drop, {:.0f} % of its variance from the {}: {}.{}",
      flow.flow_rate.in(mL_per_min), 100.0 * expanded / drop, 100.0 * most->second / all,
      most->first, mend(most->first),
      beyond_calibration(flow)
          ? " Part of the wall is beyond its calibration: calibrate to a higher "
            "pressure."
          : "");
}

}  // namespace manoscope::pipeline
