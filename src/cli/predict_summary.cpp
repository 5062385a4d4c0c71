#include "predict_summary.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "json_number.hpp"
#include "text_table.hpp"

namespace manoscope::cli {
namespace {

using nlohmann::json;
using validation::FlowPrediction;
using validation::PredictionFlag;

constexpr std::pair<FlagBits, const char*> kFlags[] = {
    {PredictionFlag::out_of_calibration, "out_of_calibration"},
    {PredictionFlag::downstream_doubt, "downstream_doubt"},
    {PredictionFlag::falling_curve, "falling_curve"},
    {PredictionFlag::separated, "separated"},
    {PredictionFlag::nearly_choked, "nearly_choked"},
};

std::string flag_names(unsigned int bits) {
  std::string names;
  for (const auto& [bit, name] : kFlags) {
    if ((bits & bit) != 0U) names += (names.empty() ? "" : "|") + std::string(name);
  }
  return names;
}

/// Every flag that stands at some station.
unsigned int any_flags(const FlowPrediction& flow) {
  unsigned int bits = 0;
  for (Index i = 0; i < flow.flags.size(); ++i) bits |= flow.flags[i];
  return bits;
}

std::string flow_text(const FlowPrediction& flow) {
  return flow_rate_text(flow.flow_rate) + " mL/min";
}

/// The value furthest from 0, with its sign.
double extreme(const Array1& values) {
  Index place = 0;
  values.abs().maxCoeff(&place);
  return values[place];
}

std::string drops_text(const pipeline::Predictions& predictions) {
  std::vector<std::vector<std::string>> rows{{"Q [mL/min]", "dp ± U [Pa]", "p inlet [Pa]",
                                              "p outlet [Pa]", "zeta extreme [um]", "Re h/l",
                                              "flags"}};
  for (const FlowPrediction& flow : predictions.flows) {
    const Index last = flow.pressure.size() - 1;
    rows.push_back({flow_rate_text(flow.flow_rate),
                    value_text(flow.drop.value, flow.drop.standard_uncertainty()),
                    fmt::format("{:.0f}", flow.pressure[0]),
                    fmt::format("{:.0f}", flow.pressure[last]),
                    fmt::format("{:.2f}", extreme(flow.zeta) * 1e6),
                    fmt::format("{:.2g}", flow.error.reduced_reynolds),
                    any_flags(flow) == 0 ? std::string("-") : flag_names(any_flags(flow))});
  }
  return text_table(rows);
}

std::string profile_text(const FlowPrediction& flow) {
  constexpr int kRows = 13;
  std::vector<std::vector<std::string>> rows{{"x [mm]", "p(x) ± U [Pa]", "zeta(x) ± U [nm]"}};
  const Array1 u = flow.uncertainty.standard(), u_zeta = flow.zeta_uncertainty.standard();
  const double length = flow.x[flow.x.size() - 1];
  for (int i = 0; i < kRows; ++i) {
    Index nearest = 0;
    (flow.x - length * (i + 0.5) / kRows).abs().minCoeff(&nearest);
    rows.push_back({fmt::format("{:.2f}", flow.x[nearest] * 1e3),
                    value_text(flow.pressure[nearest], u[nearest]),
                    value_text(flow.zeta[nearest] * 1e9, u_zeta[nearest] * 1e9)});
  }
  return flow_text(flow) + '\n' + text_table(rows);
}

}  // namespace

std::string predictions_text(const pipeline::Predictions& predictions, bool in_short) {
  std::string text = "Predicted from the calibration, drop between the ends of the channel\n" +
                     drops_text(predictions);
  for (const std::string& doubt : predictions.doubts) {
    if (!doubt.empty()) text += doubt + '\n';
  }
  if (in_short) return text;
  const flow::FlowModelInfo& model = flow::flow_model_info(predictions.flows.front().model);
  text += fmt::format("U: expanded uncertainty, k = 2. Flow model {}: {}.\n", model.name,
                      model.validity);
  if (predictions.model != model.name) text += fmt::format("Taken: {}.\n", predictions.model);
  text += fmt::format("Pressure at the outlet: {}. {}.\n", predictions.outlet, predictions.setup);
  if (!predictions.taken_as_exact.empty()) {
    text += fmt::format("U leaves out, since no uncertainty is stated: {}.\n",
                        fmt::join(predictions.taken_as_exact, ", "));
  }
  for (const FlowPrediction& flow : predictions.flows) text += '\n' + profile_text(flow);
  return text;
}

std::string predictions_json(const pipeline::Predictions& predictions) {
  json flows = json::array();
  for (std::size_t f = 0; f < predictions.flows.size(); ++f) {
    const FlowPrediction& flow = predictions.flows[f];
    const std::string& doubt = predictions.doubts[f];
    json flags = json::array();
    for (Index i = 0; i < flow.flags.size(); ++i) flags.push_back(flag_names(flow.flags[i]));
    flows.push_back({{"flow_rate_m3_s", flow.flow_rate.si()},
                     {"model", std::string(flow::flow_model_info(flow.model).name)},
                     {"drop_Pa", flow.drop.value},
                     {"drop_uncertainty_Pa", flow.drop.standard_uncertainty()},
                     {"outlet_pressure_Pa", flow.pressure[flow.pressure.size() - 1]},
                     {"reduced_reynolds", flow.error.reduced_reynolds},
                     {"x_m", numbers(flow.x)},
                     {"pressure_Pa", numbers(flow.pressure)},
                     {"pressure_uncertainty_Pa", numbers(flow.uncertainty.standard())},
                     {"deflection_m", numbers(flow.zeta)},
                     {"deflection_uncertainty_m", numbers(flow.zeta_uncertainty.standard())},
                     {"flags", flags},
                     {"doubt", doubt.empty() ? json(nullptr) : json(doubt)}});
  }
  return flows.dump(2) + '\n';
}

std::string predictions_table(const pipeline::Predictions& predictions) {
  std::string table =
      "flow_rate_m3_s,x_m,pressure_Pa,pressure_uncertainty_Pa,deflection_m,"
      "deflection_uncertainty_m,flags\n";
  for (const FlowPrediction& flow : predictions.flows) {
    const Array1 u = flow.uncertainty.standard(), u_zeta = flow.zeta_uncertainty.standard();
    for (Index i = 0; i < flow.x.size(); ++i) {
      table +=
          fmt::format("{},{},{},{},{},{},{}\n", flow.flow_rate.si(), flow.x[i], flow.pressure[i],
                      u[i], flow.zeta[i], u_zeta[i], flag_names(flow.flags[i]));
    }
  }
  return table;
}

}  // namespace manoscope::cli
