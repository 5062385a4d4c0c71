#include "manoscope/report/html_simulation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "manoscope/report/figure_data.hpp"
#include "manoscope/report/flow_verdict.hpp"
#include "manoscope/report/html_elements.hpp"
#include "manoscope/report/html_text.hpp"
#include "manoscope/report/number_text.hpp"
#include "manoscope/report/simulated_lines.hpp"

namespace manoscope::report {
namespace {

using results::Measurement;
using results::Simulation;

/// Every simulation of every run, and the kinds among them in the order of the columns.
struct AllLines {
  std::vector<std::vector<SimulatedLine>> of_run;
  std::vector<std::string> kinds;

  explicit AllLines(const Measurement& m) {
    for (std::size_t r = 0; r < m.run.size(); ++r) {
      of_run.push_back(simulated_lines(m, static_cast<Index>(r)));
      for (const SimulatedLine& line : of_run.back()) {
        if (std::find(kinds.begin(), kinds.end(), line.words) == kinds.end()) {
          kinds.push_back(line.words);
        }
      }
    }
    std::sort(kinds.begin(), kinds.end());
  }
};

std::string verdict_text(const Simulation& s, Index v) {
  const FlowVerdict verdict = flow_verdict(s.en_number[v], s.p_value[v]);
  return fmt::format("<span class=\"{}\">{}</span>", verdict_style(verdict), verdict_word(verdict));
}

/// The largest parts of the bar of a drop, as shares of the drop.
std::string parts_text(const Simulation& s, Index v) {
  std::vector<std::pair<double, std::string>> parts;
  for (std::size_t k = 0; k < s.error_source.size(); ++k) {
    const double u = std::sqrt(s.drop_variance(static_cast<Index>(k), v));
    if (u > 0.0) parts.emplace_back(kExpansion * u / std::abs(s.drop[v]), s.error_source[k]);
  }
  std::sort(parts.rbegin(), parts.rend());
  constexpr std::size_t kShown = 3;
  std::string text;
  for (std::size_t k = 0; k < std::min(parts.size(), kShown); ++k) {
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", escape_html(parts[k].second),
                        percent_text(parts[k].first));
  }
  return text.empty() ? "–" : text;
}

std::string line_row(const Measurement& m, Index run, const SimulatedLine& line,
                     const ReportUnits& units) {
  const Simulation& s = *line.simulation;
  const Index v = line.variant;
  const double unit = units.drop.si;
  return "<tr>" + row_head(m.run[static_cast<std::size_t>(run)]) +
         cell(short_number_text(m.flow_rate(run) / units.flow_rate.si)) + cell(line.words) +
         cell(number_text_with_uncertainty(s.drop[v] / unit,
                                           kExpansion * s.drop_uncertainty[v] / unit)) +
         cell(number_text_with_uncertainty(s.extracted_drop / unit,
                                           kExpansion * s.extracted_drop_uncertainty / unit)) +
         cell(signed_percent_text(
             share_of(s.drop[v] - s.extracted_drop, std::abs(s.extracted_drop)))) +
         cell(number_text(s.en_number[v], 2)) + cell(verdict_text(s, v)) + "<td class=\"words\">" +
         parts_text(s, v) + "</td><td class=\"words\">" + escape_html(s.inlet) +
         (s.converged != 0.0 ? "" : " (not converged)") + "</td><td class=\"words\">" +
         escape_html(s.roof) + "</td></tr>\n";
}

}  // namespace

std::string simulation_heads(const Measurement& m) {
  std::string heads;
  for (const std::string& kind : AllLines(m).kinds) heads += column_head(escape_html(kind));
  return heads;
}

std::string simulation_cells(const Measurement& m, Index run) {
  const AllLines all(m);
  std::string cells;
  for (const std::string& kind : all.kinds) {
    const auto& lines = all.of_run[static_cast<std::size_t>(run)];
    const auto line = std::find_if(lines.begin(), lines.end(),
                                   [&](const SimulatedLine& one) { return one.words == kind; });
    if (line == lines.end()) {
      cells += cell("–");
      continue;
    }
    const Simulation& s = *line->simulation;
    const Index v = line->variant;
    cells += agreement_cell(flow_verdict(s.en_number[v], s.p_value[v]), s.converged == 0.0,
                            share_of(s.drop[v] - s.extracted_drop, std::abs(s.extracted_drop)),
                            s.en_number[v], s.p_value[v]);
  }
  return cells;
}

std::string simulations_table(const Measurement& m) {
  const AllLines all(m);
  if (all.kinds.empty()) return {};
  const ReportUnits units = report_units(m);
  std::string body;
  for (std::size_t r = 0; r < all.of_run.size(); ++r) {
    for (const SimulatedLine& line : all.of_run[r]) {
      body += line_row(m, static_cast<Index>(r), line, units);
    }
  }
  const auto in = [&](const char* name) {
    return column_head(fmt::format("{} ({})", name, units.drop.name));
  };
  return table(
      fmt::format(
          "Navier-Stokes flow below the measured wall: drop over the test section ± expanded "
          "uncertainty (k = {:.0f}), against the drop read off the wall. Between plates (2-D) "
          "there are no side walls and the roof is flat across; what both add by the resistance of "
          "the true section is given beside the solution as it is. Bar: its largest parts; "
          "numerical from two meshes, gap, deflection, viscosity and flow rate through the plane "
          "march.",
          kExpansion),
      column_head("Run") + column_head(fmt::format("<i>Q</i> ({})", units.flow_rate.name)) +
          column_head("Simulation") + in("Simulated") + in("Read") + column_head("Difference") +
          column_head("<i>E</i><sub>n</sub>") + column_head("Verdict") +
          "<th scope=\"col\" class=\"words\">Bar</th><th scope=\"col\" class=\"words\">Inlet</th>"
          "<th scope=\"col\" class=\"words\">Shape</th>",
      body, body.size() > 14 * 400);
}

}  // namespace manoscope::report
