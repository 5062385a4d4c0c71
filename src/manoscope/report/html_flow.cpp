#include "manoscope/report/html_flow.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "manoscope/report/figure_data.hpp"
#include "manoscope/report/flow_verdict.hpp"
#include "manoscope/report/html_elements.hpp"
#include "manoscope/report/html_flow_drops.hpp"
#include "manoscope/report/html_simulation.hpp"
#include "manoscope/report/html_text.hpp"
#include "manoscope/report/number_text.hpp"
#include "manoscope/report/wording.hpp"

namespace manoscope::report {
namespace {

using results::Measurement;

/// Head of a row of the flow tables: run and flow rate.
std::string run_cells(const Measurement& m, std::size_t i, const ReportUnits& units) {
  return row_head(m.run[i]) +
         cell(short_number_text(m.flow_rate(static_cast<Index>(i)) / units.flow_rate.si));
}

std::string run_heads(const ReportUnits& units) {
  return column_head("Run") + column_head(fmt::format("<i>Q</i> ({})", units.flow_rate.name));
}

/// One model against one run: verdict, difference, E_n and chance.
std::string model_cell(const Measurement& m, Index model, Index run) {
  const double drop = m.model_drop(model, run), extracted = m.extracted_drop(run);
  if (!std::isfinite(drop)) return cell("–");
  return agreement_cell(flow_verdict(m, model, run),
                        std::isgreater(m.model_stated_error(model, run), kMostStatedError),
                        share_of(drop - extracted, std::abs(extracted)),
                        m.model_en_number(model, run), m.model_p_value(model, run));
}

std::string models_table(const Measurement& m) {
  if (!m.model_drop.isFinite().any()) return {};
  const ReportUnits units = report_units(m);
  std::string head = run_heads(units);
  for (const std::string& name : m.flow_model) {
    const std::string text = escape_html(name == "paper" ? "paper, eq. (4)" : name);
    head += column_head(name == m.verdict_model ? text + " (verdict)" : text);
  }
  head += simulation_heads(m);
  std::string body;
  for (std::size_t i = 0; i < m.run.size(); ++i) {
    body += "<tr>" + run_cells(m, i, units);
    for (Index model = 0; model < m.model_drop.rows(); ++model) {
      body += model_cell(m, model, static_cast<Index>(i));
    }
    body += simulation_cells(m, static_cast<Index>(i)) + "</tr>\n";
  }
  return table(
      fmt::format(
          "Which flow model agrees? The model's drop over the test section less Δp<sub>e</sub>, in "
          "% of Δp<sub>e</sub>; E<sub>n</sub>: that difference over its expanded uncertainty (k = "
          "{:.0f}), in which what reading and model share counts once, and which holds the stated "
          "error of the model; p: how often chance puts "
          "p(x) as far from the model along x. <span class=\"good\">Agrees</span>: E<sub>n</sub> ≤ "
          "1 and p ≥ {:g}. <span class=\"half\">Only the drop</span>: E<sub>n</sub> ≤ 1, but p(x) "
          "does not fit: errors that cancel look like this. <span class=\"bad\">Differs</span>: "
          "E<sub>n</sub> > 1. ○: the model itself may be more than {:.0f} % off at this flow, as "
          "its E<sub>n</sub> knows. All models take the gap from the same maps as p(x): a wrong "
          "gap is wrong in all of them. What is not known of the profile at the inlet is in the "
          "bar of "
          "every model: where that is wide, all of them agree.",
          kExpansion, kLeastChance, 100.0 * kMostStatedError),
      head, body, m.run.size() > 10);
}

std::string verdicts_table(const Measurement& m) {
  const ReportUnits units = report_units(m);
  std::string body;
  for (std::size_t i = 0; i < m.run.size() && i < m.verdict.size(); ++i) {
    if (m.verdict[i].empty()) continue;
    body += "<tr>" + run_cells(m, i, units) + "<td class=\"words\">" + escape_html(m.verdict[i]) +
            "</td></tr>\n";
  }
  if (body.empty()) return {};
  return table(fmt::format("The verdict of each run in words, by {}.",
                           m.verdict_model.empty() ? std::string("the flow model of the verdict")
                                                   : escape_html(m.verdict_model)),
               run_heads(units) + "<th scope=\"col\" class=\"words\">Reading and model</th>", body,
               m.run.size() > 14);
}

/// Pascals with as many digits behind the point as make four of the drop itself.
std::string pascal_text(const Measurement& m, Index run, double value) {
  const double drop = std::abs(m.extracted_drop(run));
  const int decimals =
      std::isgreater(drop, 0.0) ? 3 - static_cast<int>(std::floor(std::log10(drop))) : 1;
  return fixed_text(value, std::clamp(decimals, 0, 3));
}

/// What an effect adds in Pa, with the bar that an unknown inlet profile leaves, and in percent.
std::string effect_cell(const Measurement& m, Index effect, Index run) {
  const double part = m.correction_drop(effect, run), u = m.correction_uncertainty(effect, run);
  if (!std::isfinite(part)) return cell("–");
  std::string text = pascal_text(m, run, part);
  const std::string bar = pascal_text(m, run, std::isfinite(u) ? kExpansion * u : 0.0);
  if (bar.find_first_not_of("0.") != std::string::npos) text += " ± " + bar;
  return cell(text + "<br>" + signed_percent_text(share_of(part, m.extracted_drop(run))));
}

std::string corrections_table(const Measurement& m) {
  if (!m.correction_drop.isFinite().any()) return {};
  const ReportUnits units = report_units(m);
  std::string head = run_heads(units);
  for (const std::string& name : m.correction) head += column_head(escape_html(name) + " (Pa)");
  head += column_head("Together (Pa)") + column_head("Δ<i>p</i><sub>e</sub> (Pa)");
  std::string body;
  for (std::size_t i = 0; i < m.run.size(); ++i) {
    const auto run = static_cast<Index>(i);
    body += "<tr>" + run_cells(m, i, units);
    double sum = 0.0;
    for (Index effect = 0; effect < m.correction_drop.rows(); ++effect) {
      body += effect_cell(m, effect, run);
      const double part = m.correction_drop(effect, run);
      sum += std::isfinite(part) ? part : 0.0;
    }
    const bool any = m.correction_drop.col(run).isFinite().any() && !march_broke_down(m, run);
    body += cell(any ? pascal_text(m, run, sum) : "–") +
            cell(number_text_with_uncertainty(m.extracted_drop(run),
                                              kExpansion * m.extracted_drop_uncertainty(run))) +
            "</tr>\n";
  }
  return table(
      fmt::format(
          "What each effect adds to the drop of the test section, each to those before it, in Pa "
          "and in % of Δp<sub>e</sub>. Mean-gap rectangle: the paper's eq. (4). True section: the "
          "roof is curved across. Inertia: the flow slows down where the wall bulges, with the "
          "profiles of developed flow. Entry: development from a uniform profile, ± what an "
          "unknown inlet profile leaves (k = {:.0f}). Section march: the profiles as they are.{}",
          kExpansion, escape_html(broken_marches_text(m))),
      head, body, m.run.size() > 10);
}

}  // namespace

std::string verdict_sentence(const Measurement& m) {
  const Index model = flow_model_row(m, m.verdict_model);
  if (model < 0) return {};
  Index n_judged = 0, n_agree = 0, n_only_drop = 0;
  for (Index run = 0; run < m.model_en_number.cols(); ++run) {
    const FlowVerdict verdict = flow_verdict(m, model, run);
    n_judged += verdict != FlowVerdict::none ? 1 : 0;
    n_agree += verdict == FlowVerdict::agrees ? 1 : 0;
    n_only_drop += verdict == FlowVerdict::only_drop ? 1 : 0;
  }
  if (n_judged == 0) return {};
  return fmt::format(
      "<p>In {} of {} runs the flow model {} agrees with the reading in the drop and along "
      "<i>x</i>{}.</p>\n",
      n_agree, n_judged, escape_html(m.verdict_model),
      n_only_drop > 0 ? fmt::format(", in {} more in the drop only", n_only_drop) : std::string());
}

std::string flow_part(const Measurement& m) {
  const std::string tables = models_table(m) + simulations_table(m) + verdicts_table(m) +
                             corrections_table(m) + inferred_table(m) + channel_drops_table(m);
  if (tables.empty()) return {};
  std::string part = "<h2 id=\"flow\">Flow models</h2>\n";
  if (!m.flow_setup.empty()) {
    part += "<p>What the models take: " + escape_html(m.flow_setup) + ".</p>\n";
  }
  return part + tables;
}

}  // namespace manoscope::report
