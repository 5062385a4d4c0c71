#include "summary_flow.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "json_number.hpp"
#include "text_table.hpp"

namespace manoscope::cli {
namespace {

using nlohmann::json;
using results::Measurement;

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

}  // namespace

std::string flow_findings_text(const Measurement& m, const Screen& screen) {
  if (!m.inferred_flow_rate.isFinite().any() && !m.predicted_drop.isFinite().any()) return {};
  std::vector<Column> columns{{{"run"}, Align::left},
                              {{"Q off the wall ± U [mL/min]"}, Align::point},
                              {{"dp end to end ± U [Pa]"}, Align::point, 1}};
  for (Index r = 0; r < m.flow_rate.size(); ++r) {
    const auto in_ml = [](double si) { return FlowRate::from_si(si).in(mL_per_min); };
    add_row(columns,
            {m.run[static_cast<std::size_t>(r)],
             value_text(in_ml(m.inferred_flow_rate[r]), in_ml(m.inferred_flow_rate_uncertainty[r])),
             value_text(m.predicted_drop[r], m.predicted_drop_uncertainty[r])});
  }
  return fmt::format("By the flow model {}\n{}", m.verdict_model,
                     text_table(std::move(columns), screen)) +
         wrapped(
             "Q off the wall: from the deflection alone. dp end to end: between the ends of the "
             "channel, predicted from the calibration and the set Q.",
             screen.columns);
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

}  // namespace manoscope::cli
