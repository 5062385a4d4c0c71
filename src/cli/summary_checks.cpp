#include "summary_checks.hpp"

#include <nlohmann/json.hpp>

#include "json_number.hpp"
#include "manoscope/report/advice.hpp"
#include "manoscope/report/check_summary.hpp"
#include "text_table.hpp"

namespace manoscope::cli {
namespace {

using nlohmann::json;
using results::Measurement;

json shape_json(const Measurement& m, Index map) {
  const auto i = static_cast<std::size_t>(map);
  const int run = m.map_run[i];
  const bool of_run = run >= 0 && static_cast<std::size_t>(run) < m.run.size();
  return {{"map", m.map[i]},
          {"run", of_run ? json(m.run[static_cast<std::size_t>(run)]) : json(nullptr)},
          {"reduced_chi_square", number(m.shape_reduced_chi_square[map])},
          {"p_value", number(m.shape_p_value[map])},
          {"x_start_m", number(m.shape_worst(map, 0))},
          {"x_end_m", number(m.shape_worst(map, 1))},
          {"reading_shift_Pa", number(m.shape_reading_shift[map])}};
}

json one_advice(const std::optional<report::Advice>& advice) {
  if (!advice) return nullptr;
  return {{"source", advice->source},
          {"share_of_variance", advice->share},
          {"bars_shrink_if_halved", advice->shrink},
          {"hint", advice->hint}};
}

}  // namespace

std::string checks_text(const Measurement& m, const Screen& screen) {
  std::string text;
  for (const std::string& line : report::check_lines(m)) text += line + '\n';
  text = wrapped(text + report::advice_text(m), screen.columns);
  return text.empty() ? text : "\nChecks without truth\n" + text;
}

json checks_json(const Measurement& m) {
  const report::LeftOutSummary left_out = report::summarise_left_out(m);
  json levels = json::array();
  for (Index k = 0; k < m.left_out_mean_error.size(); ++k) {
    levels.push_back({{"level_Pa", m.level_pressure[k]},
                      {"error_Pa", number(m.left_out_mean_error[k])},
                      {"uncertainty_Pa", number(m.left_out_mean_uncertainty[k])}});
  }
  json shapes = json::array();
  for (Index i = 0; i < m.shape_p_value.size(); ++i) shapes.push_back(shape_json(m, i));
  json repeats = json::array();
  for (std::size_t i = 0; i < m.repeat.size(); ++i) {
    const auto at = static_cast<Index>(i);
    repeats.push_back({{"state", m.repeat[i]},
                       {"maps", m.repeat_maps[i]},
                       {"scatter_Pa", number(m.repeat_scatter[at])},
                       {"chi_square", number(m.repeat_chi_square[at])},
                       {"degrees_of_freedom", number(m.repeat_dof[at])},
                       {"p_value", number(m.repeat_p_value[at])}});
  }
  return {
      {"left_out",
       {{"rms_Pa", number(left_out.rms)}, {"pull_rms", number(left_out.pull)}, {"levels", levels}}},
      {"shapes", shapes},
      {"repeats", repeats},
      {"sweeps",
       {{"maps_up", number(m.sweep_up_maps)},
        {"maps_down", number(m.sweep_down_maps)},
        {"difference_Pa", number(m.sweep_difference)},
        {"uncertainty_Pa", number(m.sweep_difference_uncertainty)}}}};
}

json advice_json(const Measurement& m) {
  return {{"pressure", one_advice(report::advice_on_pressure(m))},
          {"extracted_drop", one_advice(report::advice_on_drop(m))}};
}

}  // namespace manoscope::cli
