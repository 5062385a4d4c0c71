#include "run_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "manoscope/report/flow_verdict.hpp"
#include "manoscope/report/wording.hpp"
#include "text_table.hpp"

namespace manoscope::cli {
namespace {

using report::FlowVerdict;
using results::Measurement;

/// What the flow says of one run.
struct ByFlow {
  double drop = std::nan(""), uncertainty = std::nan(""), en_number = std::nan("");
  std::string word;
  Colour colour = Colour::none;
  bool doubtful = false;  ///< the model may be too far off at this flow
};

Colour colour_of(FlowVerdict verdict) {
  switch (verdict) {
    case FlowVerdict::agrees:
      return Colour::green;
    case FlowVerdict::only_drop:
      return Colour::yellow;
    case FlowVerdict::differs:
      return Colour::red;
    case FlowVerdict::none:
      break;
  }
  return Colour::none;
}

ByFlow by_model(const Measurement& m, Index model, Index r) {
  const FlowVerdict verdict = report::flow_verdict(m, model, r);
  const bool doubtful = std::isgreater(m.model_stated_error(model, r), report::kMostStatedError);
  const Colour colour = colour_of(verdict);
  return {m.model_drop(model, r),
          m.model_drop_uncertainty(model, r),
          m.model_en_number(model, r),
          report::verdict_word(verdict),
          doubtful && colour == Colour::green ? Colour::yellow : colour,
          doubtful};
}

/// By eq. (4) taken as exact: what is beyond the bars may be the formula's fault.
ByFlow by_resistance(const Measurement& m, Index r) {
  const double en = m.en_number[r];
  const Colour beyond = std::isfinite(en) ? Colour::yellow : Colour::none;
  return {m.resistance_drop[r],
          m.resistance_drop_uncertainty[r],
          en,
          report::resistance_word(en),
          std::islessequal(en, 1.0) ? Colour::green : beyond,
          false};
}

std::vector<ByFlow> by_flow(const Measurement& m) {
  const Index model = report::flow_model_row(m, m.verdict_model);
  std::vector<ByFlow> all;
  for (Index r = 0; r < m.flow_rate.size(); ++r) {
    all.push_back(model >= 0 ? by_model(m, model, r) : by_resistance(m, r));
  }
  return all;
}

std::string table(const Measurement& m, const std::vector<ByFlow>& flow, const Screen& screen) {
  constexpr std::size_t kHeads = 2;  // what it is, and its unit
  std::vector<Column> columns{
      {{"run", ""}, Align::left},           {{"Q", "[mL/min]"}, Align::point, 2},
      {{"dp_e ± U", "[Pa]"}, Align::point}, {{"dp by the flow ± U", "[Pa]"}, Align::point, 1},
      {{"E_n", ""}, Align::point, 3},       {{"verdict", ""}, Align::left}};
  for (Index r = 0; r < m.flow_rate.size(); ++r) {
    const auto at = static_cast<std::size_t>(r);
    const ByFlow& says = flow[at];
    add_row(columns, {m.run[at], flow_rate_text(FlowRate::from_si(m.flow_rate[r])),
                      value_text(m.extracted_drop[r], m.extracted_drop_uncertainty[r]),
                      value_text(says.drop, says.uncertainty), fixed(says.en_number, 2),
                      coloured(says.word, says.colour, screen) + (says.doubtful ? "*" : "")});
  }
  return text_table(std::move(columns), screen, kHeads);
}

/// What every verdict in the table means.
std::string verdicts_text(const std::vector<ByFlow>& flow) {
  constexpr std::pair<const char*, const char*> kMeanings[] = {
      {"agrees", "E_n <= 1, and p(x) along x fits, too"},
      {"only the drop", "E_n <= 1, but p(x) along x does not fit"},
      {"differs", "E_n > 1"},
      {"no verdict", "the gap has no stated uncertainty, or a drop is missing"},
      {"within U", "E_n <= 1, eq. (4) taken as exact"},
      {"beyond U", "E_n > 1, eq. (4) taken as exact"}};
  std::string text;
  for (const auto& [word, meaning] : kMeanings) {
    const bool there = std::any_of(flow.begin(), flow.end(),
                                   [word = word](const ByFlow& f) { return f.word == word; });
    if (there) text += fmt::format("{}{}: {}", text.empty() ? "" : ". ", word, meaning);
  }
  return text + ".";
}

}  // namespace

std::string run_table(const Measurement& m, const Screen& screen) {
  const std::vector<ByFlow> flow = by_flow(m);
  const bool modelled = report::flow_model_row(m, m.verdict_model) >= 0;
  std::string text = table(m, flow, screen);
  text += wrapped(
      fmt::format("dp_e: drop over the test section, read off the wall; beside it the same by {}. "
                  "U: expanded uncertainty, k = 2.",
                  modelled ? "the flow model " + m.verdict_model : "the paper's eq. (4)"),
      screen.columns);
  text += wrapped(verdicts_text(flow), screen.columns);
  if (std::any_of(flow.begin(), flow.end(), [](const ByFlow& f) { return f.doubtful; })) {
    text += wrapped("*: the model itself may be more than 2 % off at this flow.", screen.columns);
  }
  return text;
}

}  // namespace manoscope::cli
