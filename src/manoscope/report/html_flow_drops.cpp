#include "manoscope/report/html_flow_drops.hpp"

#include <fmt/format.h>

#include <cmath>

#include "manoscope/report/figure_data.hpp"
#include "manoscope/report/html_elements.hpp"
#include "manoscope/report/html_text.hpp"
#include "manoscope/report/number_text.hpp"

namespace manoscope::report {
namespace {

using results::Measurement;

std::string with_bar(double value, double uncertainty, double unit) {
  return number_text_with_uncertainty(value / unit, kExpansion * uncertainty / unit);
}

std::string en_text(double en_number) {
  if (!std::isfinite(en_number)) return "–";
  return fmt::format("<span class=\"{}\">{:.2f}</span>", en_number <= 1.0 ? "good" : "bad",
                     en_number);
}

}  // namespace

std::string inferred_table(const Measurement& m) {
  const ReportUnits units = report_units(m);
  const double Q = units.flow_rate.si;
  std::string body;
  for (std::size_t i = 0; i < m.run.size(); ++i) {
    const auto run = static_cast<Index>(i);
    const double set = m.flow_rate(run), found = m.inferred_flow_rate(run);
    if (!std::isfinite(found) && !std::isfinite(m.inferred_viscosity(run))) continue;
    const double u =
        std::hypot(m.inferred_flow_rate_uncertainty(run), m.flow_rate_uncertainty(run));
    body += "<tr>" + row_head(m.run[i]) + cell(with_bar(set, m.flow_rate_uncertainty(run), Q)) +
            cell(with_bar(found, m.inferred_flow_rate_uncertainty(run), Q)) +
            cell(signed_percent_text(share_of(found - set, set))) +
            cell(en_text(share_of(std::abs(found - set), kExpansion * u))) +
            cell(chance_text(m.inferred_flow_rate_p_value(run), 0.01)) +
            cell(with_bar(m.inferred_viscosity(run), m.inferred_viscosity_uncertainty(run), 1e-3)) +
            "</tr>\n";
  }
  if (body.empty()) return {};
  return table(
      fmt::format(
          "The flow rate from the deflection alone: the one whose pressure, by {} through the "
          "measured gap, falls along the test section as p(x) does; ± expanded uncertainty (k = "
          "{:.0f}). E<sub>n</sub>: against the set flow rate. Chance: how often chance leaves as "
          "much of p(x) "
          "unexplained. The gap counts threefold: 1 % of 2h<sub>0</sub> is 3 % of Q. This is the "
          "comparison of p(x) with the model turned round, no second proof of it. Viscosity: the "
          "same with the flow rate known; stated is {} mPa s.",
          m.verdict_model.empty() ? std::string("the flow model") : escape_html(m.verdict_model),
          kExpansion, short_number_text(m.viscosity * 1e3)),
      column_head("Run") + column_head(fmt::format("Set <i>Q</i> ({})", units.flow_rate.name)) +
          column_head(fmt::format("<i>Q</i> from the deflection ({})", units.flow_rate.name)) +
          column_head("Difference") + column_head("<i>E</i><sub>n</sub>") + column_head("Chance") +
          column_head("Viscosity from the deflection (mPa s)"),
      body, m.run.size() > 14);
}

std::string channel_drops_table(const Measurement& m) {
  if (!m.compliant_drop.isFinite().any() && !m.predicted_drop.isFinite().any() &&
      !m.passage_drop.isFinite().any()) {
    return {};
  }
  const ReportUnits units = report_units(m);
  const bool passages = m.parasitic_drop.isFinite().any();
  const auto in = [&](const std::string& name) {
    return column_head(fmt::format("{} ({})", name, units.drop.name));
  };
  std::string head = column_head("Run") +
                     column_head(fmt::format("<i>Q</i> ({})", units.flow_rate.name)) +
                     in("Transducer");
  for (const std::string& term : m.passage_term) head += in(escape_html(term));
  if (passages) head += in("Parasitic") + in("Transducer − parasitic");
  head += in("Predicted");
  if (passages) head += column_head("<i>E</i><sub>n</sub>");
  std::string body;
  for (std::size_t i = 0; i < m.run.size(); ++i) {
    const auto run = static_cast<Index>(i);
    const auto drop = [&](const Array1& value, const Array1& uncertainty) {
      return cell(with_bar(value(run), uncertainty(run), units.drop.si));
    };
    body += "<tr>" + row_head(m.run[i]) +
            cell(short_number_text(m.flow_rate(run) / units.flow_rate.si)) +
            drop(m.transducer_drop, m.transducer_drop_uncertainty);
    for (Index term = 0; term < m.passage_drop.rows(); ++term) {
      body += cell(with_bar(m.passage_drop(term, run), m.passage_drop_uncertainty(term, run),
                            units.drop.si));
    }
    if (passages) {
      body += drop(m.parasitic_drop, m.parasitic_drop_uncertainty) +
              drop(m.compliant_drop, m.compliant_drop_uncertainty);
    }
    body += drop(m.predicted_drop, m.predicted_drop_uncertainty);
    if (passages) body += cell(en_text(m.predicted_en_number(run)));
    body += "</tr>\n";
  }
  std::string words = fmt::format(
      "Drop between the ends of the channel ± expanded uncertainty (k = {:.0f}). Predicted: from "
      "the calibration and the set flow rate by {}, without the map under flow; but where no "
      "outlet gauge is told, the pressure at the outlet is taken from the reading of that very "
      "map.",
      kExpansion,
      m.verdict_model.empty() ? std::string("the flow model") : escape_html(m.verdict_model));
  words +=
      passages
          ? " Parasitic: what the rigid passages between gauge and channel cost, by part "
            "(uncertainty of its formula) and in all (flow rate, viscosity and the height of the "
            "passages included). E<sub>n</sub>: predicted against transducer − parasitic. The "
            "transducer is "
            "independent of the wall and its curves unless it is the gauge they were "
            "made with; that the passages are right, it takes for granted."
          : " The experiment tells of no rigid passages: what they cost is in the "
            "transducer's reading, and nothing is held against it.";
  return table(words, head, body, m.run.size() > 14);
}

}  // namespace manoscope::report
