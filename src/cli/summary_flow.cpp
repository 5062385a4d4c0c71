#include "summary_flow.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "manoscope/report/flow_verdict.hpp"
#include "text_table.hpp"

namespace manoscope::cli {
namespace {

using nlohmann::json;
using results::Measurement;

constexpr double kMlPerMin = 60e6;

json number(double value) { return std::isfinite(value) ? json(value) : json(nullptr); }

bool beyond_validity(const Measurement& m, Index model, Index run) {
  return model >= 0 && std::isgreater(m.model_stated_error(model, run), report::kMostStatedError);
}

std::vector<std::string> run_row(const Measurement& m, Index model, Index r) {
  const bool known = model >= 0;
  const double en = known ? m.model_en_number(model, r) : std::nan("");
  const std::string word = report::verdict_word(report::flow_verdict(m, model, r));
  return {m.run[static_cast<std::size_t>(r)],
          known ? value_text(m.model_drop(model, r), m.model_drop_uncertainty(model, r))
                : std::string("-"),
          std::isfinite(en) ? fmt::format("{:.2f}", en) : std::string("-"),
          word + (beyond_validity(m, model, r) ? "*" : ""),
          value_text(m.inferred_flow_rate[r] * kMlPerMin,
                     m.inferred_flow_rate_uncertainty[r] * kMlPerMin),
          value_text(m.predicted_drop[r], m.predicted_drop_uncertainty[r])};
}

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

std::string flow_checks_text(const Measurement& m) {
  const Index model = report::flow_model_row(m, m.verdict_model);
  const bool compared = model >= 0 && m.model_drop.row(model).isFinite().any();
  if (!compared && !m.inferred_flow_rate.isFinite().any() && !m.predicted_drop.isFinite().any()) {
    return {};
  }
  std::vector<std::vector<std::string>> rows{{"run", "dp model ± U [Pa]", "E_n", "verdict",
                                              "Q off the wall [mL/min]", "dp predicted [Pa]"}};
  bool doubtful = false;
  for (Index r = 0; r < m.flow_rate.size(); ++r) {
    rows.push_back(run_row(m, model, r));
    doubtful = doubtful || beyond_validity(m, model, r);
  }
  std::string text = fmt::format(
      "\nBy the flow model {}\n{}dp model: over the section, against dp_e above; agrees: E_n <= 1 "
      "and the pressure along x fits, too.\nQ off the wall: from the deflection alone. dp "
      "predicted: "
      "between the ends of the channel, from the\ncalibration and the set Q.\n",
      m.verdict_model, text_table(rows));
  if (doubtful) text += "*: the model itself may be more than 2 % off at this flow.\n";
  return text;
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
