#include "manoscope/experiment/file_doubts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace manoscope::experiment {

std::vector<std::string> label_doubts(const Experiment& experiment) {
  const auto& maps = experiment.hydrostatic;
  const auto n_vented =
      std::count_if(maps.begin(), maps.end(), [](const HydrostaticMap& map) { return map.vented; });
  const auto n_unknown = std::count_if(maps.begin(), maps.end(), [](const HydrostaticMap& map) {
    return !map.pressure_uncertainty;
  });
  const auto n_exact = std::count_if(maps.begin(), maps.end(), [](const HydrostaticMap& map) {
    return !map.vented && map.pressure_uncertainty == Pressure{};
  });
  const auto n_gauged = static_cast<std::ptrdiff_t>(maps.size()) - n_vented;
  std::vector<std::string> doubts;
  if (n_unknown > 0 && n_unknown == n_gauged) {
    doubts.emplace_back(
        "No pressure label has an uncertainty, for neither instrument.pressure_noise nor a column "
        "pressure_uncertainty is given: the labels count as exact, and the error bars are too "
        "small, often by far");
  } else if (n_unknown > 0) {
    doubts.push_back(fmt::format(
        "{} of {} pressure labels have no uncertainty (no instrument.pressure_noise, an empty cell "
        "of pressure_uncertainty): they count as exact, and the error bars are too small",
        n_unknown, n_gauged));
  }
  if (n_exact > 0) {
    doubts.push_back(fmt::format(
        "{} of {} pressure labels read on the gauge have a stated uncertainty of 0 "
        "(instrument.pressure_noise, pressure_uncertainty): they count as exact, and the error "
        "bars lack the noise of the gauge",
        n_exact, n_gauged));
  }
  return doubts;
}

std::vector<std::string> flow_doubts(const Experiment& experiment) {
  if (experiment.channel.height_uncertainty || experiment.flow.empty()) return {};
  return {"channel.height_uncertainty is not given: the uncertainty of QR lacks that of the gap"};
}

std::vector<std::string> file_doubts(const Experiment& experiment) {
  std::vector<std::string> doubts = label_doubts(experiment);
  for (std::string& doubt : flow_doubts(experiment)) doubts.push_back(std::move(doubt));
  return doubts;
}

}  // namespace manoscope::experiment
