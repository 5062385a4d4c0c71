#include "passages_summary.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "text_table.hpp"

namespace manoscope::cli {
namespace {

using nlohmann::json;
using pipeline::ParasiticDrop;
using pipeline::SolvedPassage;

std::string passage_text(const SolvedPassage& passage) {
  if (passage.n_unknowns == 0.0) return "-";
  return value_text(passage.drop, passage.drop_uncertainty);
}

json passage_json(const SolvedPassage& passage) {
  if (passage.n_unknowns == 0.0) return nullptr;
  return {
      {"drop_Pa", passage.drop},        {"drop_numerical_uncertainty_Pa", passage.drop_uncertainty},
      {"converged", passage.converged}, {"unknowns", passage.n_unknowns},
      {"seconds", passage.seconds},     {"peak_MB", passage.peak_memory / 1e6}};
}

}  // namespace

std::string passages_text(const std::vector<ParasiticDrop>& drops, bool in_short) {
  std::vector<std::vector<std::string>> rows{
      {"Q [mL/min]", "inlet [Pa]", "outlet [Pa]", "bends [Pa]", "both ± U [Pa]", "formulas ± U"}};
  double seconds = 0.0;
  for (const ParasiticDrop& drop : drops) {
    rows.push_back({fmt::format("{:.4g}", drop.flow_rate.in(mL_per_min)), passage_text(drop.inlet),
                    passage_text(drop.outlet), value_text(drop.bends, drop.bends_uncertainty),
                    value_text(drop.drop(), drop.uncertainty()),
                    value_text(drop.formula, drop.formula_uncertainty)});
    seconds += drop.inlet.seconds + drop.outlet.seconds;
  }
  std::string text =
      "Drop of the rigid passages, Navier-Stokes 3-D (parasitic drop)\n" + text_table(rows);
  if (in_short) return text;
  text += fmt::format(
      "U: expanded uncertainty, k = 2; of inlet and outlet numerical alone. {:.3g} s.\n\n"
      "To measure with these drops instead of the formulas, put into [rigid] of "
      "experiment.toml:\n\n",
      seconds);
  return text + pipeline::simulated_key(drops);
}

std::string passages_json(const std::vector<ParasiticDrop>& drops) {
  json all = json::array();
  for (const ParasiticDrop& drop : drops) {
    all.push_back({{"flow_rate_m3_s", drop.flow_rate.si()},
                   {"inlet", passage_json(drop.inlet)},
                   {"outlet", passage_json(drop.outlet)},
                   {"bends_drop_Pa", drop.bends},
                   {"bends_drop_uncertainty_Pa", drop.bends_uncertainty},
                   {"parasitic_drop_Pa", drop.drop()},
                   {"parasitic_drop_uncertainty_Pa", drop.uncertainty()},
                   {"formula_drop_Pa", drop.formula},
                   {"formula_drop_uncertainty_Pa", drop.formula_uncertainty}});
  }
  return json{{"passages", all}, {"experiment_file", pipeline::simulated_key(drops)}}.dump() + '\n';
}

}  // namespace manoscope::cli
