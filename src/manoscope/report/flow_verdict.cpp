#include "manoscope/report/flow_verdict.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "manoscope/report/plot_script.hpp"

namespace manoscope::report {

FlowVerdict flow_verdict(double en_number, double p_value) {
  if (std::isnan(en_number)) return FlowVerdict::none;
  if (en_number > 1.0) return FlowVerdict::differs;
  return std::isgreaterequal(p_value, kLeastChance) ? FlowVerdict::agrees : FlowVerdict::only_drop;
}

FlowVerdict flow_verdict(const results::Measurement& m, Index model, Index run) {
  if (model < 0) return FlowVerdict::none;
  return flow_verdict(m.model_en_number(model, run), m.model_p_value(model, run));
}

bool march_broke_down(const results::Measurement& m, Index run) {
  const Index march = flow_model_row(m, "section-march"), paper = flow_model_row(m, "paper");
  return march >= 0 && paper >= 0 && m.flow_rate(run) > 0.0 &&
         std::isfinite(m.model_drop(paper, run)) && !std::isfinite(m.model_drop(march, run));
}

const char* verdict_word(FlowVerdict verdict) {
  switch (verdict) {
    case FlowVerdict::agrees:
      return "agrees";
    case FlowVerdict::only_drop:
      return "only the drop";
    case FlowVerdict::differs:
      return "differs";
    case FlowVerdict::none:
      break;
  }
  return "no verdict";
}

Index flow_model_row(const results::Measurement& m, std::string_view name) {
  const auto place = std::find(m.flow_model.begin(), m.flow_model.end(), name);
  return place == m.flow_model.end() ? -1 : static_cast<Index>(place - m.flow_model.begin());
}

ModelStyle model_style(std::string_view name) {
  static constexpr std::array<std::pair<std::string_view, ModelStyle>, 7> kStyles{{
      {"paper", {"eq. (4)", kGrey}},
      {"creeping", {"creeping flow", kPurple}},
      {"momentum", {"momentum", kOrange}},
      {"energy", {"energy", kSky}},
      {"developing", {"developing flow", kRed}},
      {"plane-march", {"plane march", kBlack}},
      {"section-march", {"section march", kGreen}},
  }};
  for (const auto& [known, style] : kStyles) {
    if (known == name) return style;
  }
  return {"another model", kGrey};
}

}  // namespace manoscope::report
