#include "manoscope/report/summary_json.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "manoscope/report/advice.hpp"
#include "manoscope/report/check_summary.hpp"

namespace manoscope::report {
namespace {

using nlohmann::json;
using results::Measurement;

json number(double value) { return std::isfinite(value) ? json(value) : json(nullptr); }

json models_json(const Measurement& m, Index r) {
  json models = json::array();
  for (std::size_t i = 0; i < m.flow_model.size(); ++i) {
    const auto f = static_cast<Index>(i);
    models.push_back({{"name", m.flow_model[i]},
                      {"drop_Pa", number(m.model_drop(f, r))},
                      {"drop_uncertainty_Pa", number(m.model_drop_uncertainty(f, r))},
                      {"en_number", number(m.model_en_number(f, r))},
                      {"p_value", number(m.model_p_value(f, r))},
                      {"stated_error", number(m.model_stated_error(f, r))}});
  }
  return models;
}

json corrections_json(const Measurement& m, Index r) {
  json corrections = json::array();
  for (std::size_t i = 0; i < m.correction.size(); ++i) {
    const auto k = static_cast<Index>(i);
    corrections.push_back({{"name", m.correction[i]},
                           {"drop_Pa", number(m.correction_drop(k, r))},
                           {"uncertainty_Pa", number(m.correction_uncertainty(k, r))}});
  }
  return corrections;
}

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

json one_advice(const std::optional<Advice>& advice) {
  if (!advice) return nullptr;
  return {{"source", advice->source},
          {"share_of_variance", advice->share},
          {"bars_shrink_if_halved", advice->shrink},
          {"hint", advice->hint}};
}

json checks_json(const Measurement& m) {
  const LeftOutSummary left_out = summarise_left_out(m);
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
  return {{"pressure", one_advice(advice_on_pressure(m))},
          {"extracted_drop", one_advice(advice_on_drop(m))}};
}

json flow_checks_json(const Measurement& m, Index r) {
  const auto i = static_cast<std::size_t>(r);
  return {{"verdict", i < m.verdict.size() ? json(m.verdict[i]) : json(nullptr)},
          {"models", models_json(m, r)},
          {"corrections", corrections_json(m, r)},
          {"inferred_flow_rate_m3_s", number(m.inferred_flow_rate[r])},
          {"inferred_flow_rate_uncertainty_m3_s", number(m.inferred_flow_rate_uncertainty[r])},
          {"inferred_viscosity_Pa_s", number(m.inferred_viscosity[r])},
          {"inferred_viscosity_uncertainty_Pa_s", number(m.inferred_viscosity_uncertainty[r])},
          {"transducer_drop_uncertainty_Pa", number(m.transducer_drop_uncertainty[r])},
          {"parasitic_drop_uncertainty_Pa", number(m.parasitic_drop_uncertainty[r])},
          {"compliant_drop_Pa", number(m.compliant_drop[r])},
          {"compliant_drop_uncertainty_Pa", number(m.compliant_drop_uncertainty[r])},
          {"predicted_drop_Pa", number(m.predicted_drop[r])},
          {"predicted_drop_uncertainty_Pa", number(m.predicted_drop_uncertainty[r])},
          {"predicted_en_number", number(m.predicted_en_number[r])},
          {"friction_drag_N", number(m.friction_drag[r])},
          {"relative_friction_drag", number(m.relative_friction_drag[r])},
          {"reduced_reynolds", number(m.reduced_reynolds[r])}};
}

}  // namespace

nlohmann::json summary_json(const Measurement& m, const std::string& folder) {
  json runs = json::array();
  for (Index r = 0; r < m.flow_rate.size(); ++r) {
    runs.push_back({{"run", m.run[static_cast<std::size_t>(r)]},
                    {"flow_rate_m3_s", m.flow_rate[r]},
                    {"reynolds", number(m.reynolds[r])},
                    {"x_start_m", number(m.test_section(r, 0))},
                    {"x_end_m", number(m.test_section(r, 1))},
                    {"extracted_drop_Pa", number(m.extracted_drop[r])},
                    {"extracted_drop_uncertainty_Pa", number(m.extracted_drop_uncertainty[r])},
                    {"resistance_drop_Pa", number(m.resistance_drop[r])},
                    {"resistance_drop_uncertainty_Pa", number(m.resistance_drop_uncertainty[r])},
                    {"transducer_drop_Pa", number(m.transducer_drop[r])},
                    {"parasitic_drop_Pa", number(m.parasitic_drop[r])},
                    {"en_number", number(m.en_number[r])},
                    {"tube_law_b_N_m", number(m.tube_law_b[r])},
                    {"tube_law_b_uncertainty_N_m", number(m.tube_law_b_uncertainty[r])}});
    runs.back().update(flow_checks_json(m, r));
  }
  return {
      {"output", folder},         {"uncertainties", "standard, k = 1"}, {"runs", runs},
      {"checks", checks_json(m)}, {"improve_first", advice_json(m)},    {"warnings", m.warnings}};
}

}  // namespace manoscope::report
